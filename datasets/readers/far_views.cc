// SPDX-License-Identifier: MIT
#include "datasets/readers/far_views.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "datasets/types/median.h"

namespace sketchsplat {
namespace {

constexpr double kLeastPixels = 1;

Eigen::Vector3d median_center(const std::vector<View>& views) {
  Eigen::Vector3d center;
  for (int k = 0; k < 3; ++k) {
    std::vector<double> values;
    for (const View& view : views) values.push_back(view.center_in_world()[k]);
    center[k] = median(std::move(values));
  }
  return center;
}

}  // namespace

void leave_out_far_views(Scene* scene) {
  if (scene->views.size() < 3) return;
  const Eigen::Vector3d center = median_center(scene->views);
  std::vector<double> distances;
  for (const View& view : scene->views)
    distances.push_back((view.center_in_world() - center).norm());
  const double size = median(distances);
  if (!(size > 0)) return;
  std::vector<View> near;
  std::vector<int> index(scene->views.size(), -1);  // of a view that stays
  for (size_t i = 0; i < scene->views.size(); ++i) {
    const View& view = scene->views[i];
    const double focal = std::max(view.camera.fx, view.camera.fy);
    if (focal * size >= kLeastPixels * distances[i]) {
      index[i] = int(near.size());
      near.push_back(view);
    } else {
      scene->warnings.push_back("frame " + view.name +
                                " is left out: its camera is too far away to see anything");
    }
  }
  scene->views = std::move(near);
  for (ScenePoint& point : scene->points) {
    std::vector<PointSight> seen;
    for (const PointSight& sight : point.sights)
      if (index[sight.view] >= 0) seen.push_back({index[sight.view], sight.pixel});
    point.sights = std::move(seen);
  }
}

}  // namespace sketchsplat
