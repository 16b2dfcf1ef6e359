// SPDX-License-Identifier: MIT
#include "edges/surfel_target.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace sketchsplat {
namespace {

SurfelTarget make_target(const TrainingView& full, int side, const Eigen::Vector3d& middle) {
  SurfelTarget t;
  t.view = shrink(full, side);
  const Camera& camera = t.view.view.camera;
  const int w = camera.width, h = camera.height, margin = std::max(4, side / 25);
  const cv::Mat1f alpha(h, w, t.view.alpha.data.data());
  cv::Mat1b near;
  cv::dilate(alpha > 0.02f, near, cv::Mat::ones(2 * margin + 1, 2 * margin + 1, CV_8U));
  t.mask = Image<std::uint8_t>(w, h);
  for (int i = 0; i < w * h; ++i) t.mask.data[i] = near(i / w, i % w) != 0;
  t.footprint = std::max(1e-300, (t.view.view.cam_from_world * middle).z() / camera.fx);
  return t;
}

}  // namespace

std::vector<SurfelTarget> make_targets(const std::vector<TrainingView>& views, int side,
                                       const Eigen::Vector3d& middle) {
  std::vector<SurfelTarget> targets(views.size());
#pragma omp parallel for schedule(dynamic, 1)
  for (int v = 0; v < int(views.size()); ++v) targets[v] = make_target(views[v], side, middle);
  return targets;
}

}  // namespace sketchsplat
