// SPDX-License-Identifier: MIT
#include "datasets/synthetic/photo/tie_points.h"

#include <algorithm>
#include <cmath>

#include "datasets/synthetic/render/noise.h"

namespace sketchsplat {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr int kPerView = 100;
constexpr double kOnPlain = 0.25;  // of the points there have a texture

bool draws(const View& view, const Vector3d& point, Vector2d* pixel) {
  double depth;
  const Vector2d ideal = view.project(point, &depth);
  return depth > 0 && view.image_pixel(ideal, pixel) && view.camera.contains(*pixel);
}

}  // namespace

std::vector<TiePoint> tie_points(const PhotoWorld& world, const PhotoShader& shader,
                                 const std::vector<View>& views, double lift, std::uint64_t seed) {
  std::vector<TiePoint> points;
  for (int k = 0; k < int(views.size()); ++k) {
    const View& view = views[k];
    const Vector3f eye = view.center_in_world().cast<float>();
    for (int i = 0; i < kPerView; ++i) {
      const std::uint64_t bits = hash(seed, k, i, 110);
      const Vector2d pixel(uniform(bits) * (view.camera.width - 1),
                           uniform(mix(bits)) * (view.camera.height - 1));
      Vector2d ideal;
      if (!view.ideal_pixel(pixel, &ideal)) continue;
      const Vector3f way =
          (view.cam_from_world.rotation.transpose() * view.camera.ray(ideal)).cast<float>();
      const Hit hit = world.tracer.cast(eye, way);
      if (hit.face < 0 || shader.shines(hit.face)) continue;
      const Vector3f at = eye + hit.depth * way;
      const bool plain = !shader.has_print(hit.face, at);
      if (plain && uniform(hash(seed, k, i, 111)) > kOnPlain) continue;
      const Vector3f from = at + float(lift) * hit.facet_normal;
      TiePoint point{at.cast<double>(), shader.albedo(at, hit.face), {}};
      for (int j = 0; j < int(views.size()); ++j) {
        const Vector3f other = views[j].center_in_world().cast<float>();
        PointSight sight{j, {}};
        if (j != k && uniform(hash(seed, k * kPerView + i, j, 112)) < 1.0 / 3) continue;
        if (hit.facet_normal.dot((other - at).normalized()) < 0.2f) continue;
        if (draws(views[j], point.point, &sight.pixel) && !world.tracer.blocked(from, other))
          point.sights.push_back(sight);
      }
      if (point.sights.size() >= 3) points.push_back(point);
    }
  }
  return points;
}

std::vector<TiePoint> triangulated(const std::vector<TiePoint>& points,
                                   const std::vector<View>& views) {
  std::vector<TiePoint> out;
  for (TiePoint point : points)
    if (triangulate(views, point.sights, &point.point)) out.push_back(point);
  return out;
}

double reprojection_error(const TiePoint& point, const std::vector<View>& views) {
  double sum = 0;
  for (const PointSight& sight : point.sights) {
    double depth;
    Vector2d pixel;
    const View& view = views[sight.view];
    if (view.image_pixel(view.project(point.point, &depth), &pixel))
      sum += (pixel - sight.pixel).norm();
  }
  return sum / double(point.sights.size());
}

}  // namespace sketchsplat
