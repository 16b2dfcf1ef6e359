// SPDX-License-Identifier: MIT
#include "datasets/synthetic/tracer.h"

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <cstring>
#include <limits>

namespace sketchsplat {

struct Tracer::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  SurfaceMesh mesh;
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
  Hit hit;
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;
  const SurfaceMesh& mesh = impl_->mesh;
  const auto& corner = mesh.corners[query.hit.primID];
  const float u = query.hit.u, v = query.hit.v;
  hit.face = mesh.face[query.hit.primID];
  hit.depth = query.ray.tfar;
  hit.facet_normal = Eigen::Vector3f(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z).normalized();
  if (hit.facet_normal.dot(direction) > 0) hit.facet_normal = -hit.facet_normal;
  hit.normal = (mesh.normals[corner[0]] * (1 - u - v) + mesh.normals[corner[1]] * u +
                mesh.normals[corner[2]] * v)
                   .normalized();
  // A sheet is lit on both sides, and so is a solid whose faces look inwards.
  if (hit.normal.dot(hit.facet_normal) < 0) hit.normal = -hit.normal;
  return hit;
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

}  // namespace sketchsplat
