// SPDX-License-Identifier: MIT
#include "datasets/synthetic/render/tracer.h"

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstring>
#include <limits>

namespace sketchsplat {
namespace {

constexpr int kPacket = 8;  // rays that are traced at once

}  // namespace

struct Tracer::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  SurfaceMesh mesh;
  Hit hit_at(unsigned triangle, float depth, float u, float v, const Eigen::Vector3f& facet_normal,
             const Eigen::Vector3f& direction) const;
  ~Impl() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
};

Tracer::Tracer(const SurfaceMesh& mesh) {
  auto impl = std::make_shared<Impl>();
  impl->mesh = mesh;
  impl->device = rtcNewDevice("threads=1");  // one thread builds the same tree every time
  impl->scene = rtcNewScene(impl->device);
  rtcSetSceneFlags(impl->scene, RTC_SCENE_FLAG_ROBUST);  // no leaks between triangles
  RTCGeometry geometry = rtcNewGeometry(impl->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  const auto copy = [&](RTCBufferType type, RTCFormat format, const void* data, size_t stride,
                        size_t count) {
    void* target = rtcSetNewGeometryBuffer(geometry, type, 0, format, stride, count);
    if (count > 0) std::memcpy(target, data, stride * count);
  };
  copy(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.points.data(), sizeof(Eigen::Vector3f),
       mesh.points.size());
  copy(RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.corners.data(), 3 * sizeof(unsigned),
       mesh.corners.size());
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(impl->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(impl->scene);
  impl_ = impl;
}

Hit Tracer::Impl::hit_at(unsigned triangle, float depth, float u, float v,
                         const Eigen::Vector3f& facet_normal,
                         const Eigen::Vector3f& direction) const {
  const auto& corner = mesh.corners[triangle];
  Hit hit;
  hit.face = mesh.face[triangle];
  hit.depth = depth;
  hit.facet_normal = facet_normal.normalized();
  if (hit.facet_normal.dot(direction) > 0) hit.facet_normal = -hit.facet_normal;
  hit.normal = (mesh.normals[corner[0]] * (1 - u - v) + mesh.normals[corner[1]] * u +
                mesh.normals[corner[2]] * v)
                   .normalized();
  // A sheet is lit on both sides, and so is a solid whose faces look inwards.
  if (hit.normal.dot(hit.facet_normal) < 0) hit.normal = -hit.normal;
  return hit;
}

Hit Tracer::cast(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  query.ray.org_x = origin.x(), query.ray.org_y = origin.y(), query.ray.org_z = origin.z();
  query.ray.dir_x = direction.x(), query.ray.dir_y = direction.y(), query.ray.dir_z = direction.z();
  query.ray.tfar = std::numeric_limits<float>::infinity();
  query.ray.mask = ~0u;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(impl_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return Hit();
  return impl_->hit_at(query.hit.primID, query.ray.tfar, query.hit.u, query.hit.v,
                       {query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z}, direction);
}

void Tracer::cast(const Eigen::Vector3f& origin, const Eigen::Vector3f* directions, int n,
                  Hit* hits) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  for (int first = 0; first < n; first += kPacket) {
    alignas(32) int valid[kPacket];
    alignas(32) RTCRayHit8 query{};
    for (int i = 0; i < kPacket; ++i) {
      valid[i] = first + i < n ? -1 : 0;
      const Eigen::Vector3f& d = directions[std::min(first + i, n - 1)];
      query.ray.org_x[i] = origin.x(), query.ray.org_y[i] = origin.y();
      query.ray.org_z[i] = origin.z();
      query.ray.dir_x[i] = d.x(), query.ray.dir_y[i] = d.y(), query.ray.dir_z[i] = d.z();
      query.ray.tfar[i] = std::numeric_limits<float>::infinity();
      query.ray.mask[i] = ~0u;
      query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect8(valid, impl_->scene, &context, &query);
    for (int i = 0; i < kPacket && first + i < n; ++i) {
      const auto& h = query.hit;
      hits[first + i] =
          h.geomID[i] == RTC_INVALID_GEOMETRY_ID
              ? Hit()
              : impl_->hit_at(h.primID[i], query.ray.tfar[i], h.u[i], h.v[i],
                              {h.Ng_x[i], h.Ng_y[i], h.Ng_z[i]}, directions[first + i]);
    }
  }
}

int Tracer::num_faces() const {
  const std::vector<int>& face = impl_->mesh.face;
  return face.empty() ? 0 : 1 + *std::max_element(face.begin(), face.end());
}

bool Tracer::blocked(const Eigen::Vector3f& from, const Eigen::Vector3f& to) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  const Eigen::Vector3f d = to - from;
  RTCRay ray{};
  ray.org_x = from.x(), ray.org_y = from.y(), ray.org_z = from.z();
  ray.dir_x = d.x(), ray.dir_y = d.y(), ray.dir_z = d.z();
  ray.tfar = 1.0f;
  ray.mask = ~0u;
  rtcOccluded1(impl_->scene, &context, &ray);
  return ray.tfar < 0;
}

int Tracer::count_visible(const Eigen::Vector3f& from, const Eigen::Vector3f* to, int n) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  int visible = 0;
  for (int first = 0; first < n; first += kPacket) {
    alignas(32) int valid[kPacket];
    alignas(32) RTCRay8 rays{};
    for (int i = 0; i < kPacket; ++i) {
      valid[i] = first + i < n ? -1 : 0;
      const Eigen::Vector3f d = to[std::min(first + i, n - 1)] - from;
      rays.org_x[i] = from.x(), rays.org_y[i] = from.y(), rays.org_z[i] = from.z();
      rays.dir_x[i] = d.x(), rays.dir_y[i] = d.y(), rays.dir_z[i] = d.z();
      rays.tfar[i] = 1.0f;
      rays.mask[i] = ~0u;
    }
    rtcOccluded8(valid, impl_->scene, &context, &rays);
    for (int i = 0; i < kPacket && first + i < n; ++i) visible += rays.tfar[i] >= 0;
  }
  return visible;
}

}  // namespace sketchsplat
