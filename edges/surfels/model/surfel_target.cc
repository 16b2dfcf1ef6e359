// SPDX-License-Identifier: MIT
#include "edges/surfels/model/surfel_target.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "datasets/types/parallel.h"
#include "edges/image/mats.h"

namespace sketchsplat {
namespace {

constexpr int kWindow = 6;  // [px] beyond what is looked at, for windows about its pixels

TrainingView part(const TrainingView& view, const cv::Rect& box) {
  TrainingView out;
  out.view = view.view;
  out.view.camera = view.view.camera.cut(box.x, box.y, box.width, box.height);
  for (int c = 0; c < 3; ++c)
    out.color[c] = cut(view.color[c], box.x, box.y, box.width, box.height);
  out.alpha = cut(view.alpha, box.x, box.y, box.width, box.height);
  return out;
}

SurfelTarget make_target(const TrainingView& full, int side, const Eigen::Vector3d& middle) {
  TrainingView small = shrink(full, side);
  const int w = small.alpha.width, h = small.alpha.height, margin = std::max(4, side / 25);
  cv::Mat1b near;
  cv::dilate(mat_of(small.alpha) > 0.02f, near,
             cv::Mat::ones(2 * margin + 1, 2 * margin + 1, CV_8U));
  cv::Rect box = cv::boundingRect(near);
  box -= cv::Point(kWindow, kWindow), box += cv::Size(2 * kWindow, 2 * kWindow);
  box &= cv::Rect(0, 0, w, h);
  SurfelTarget t;
  t.view = part(small, box);
  const Camera& camera = t.view.view.camera;
  t.mask = image_of<std::uint8_t>(near(box) & 1);
  t.footprint = std::max(1e-300, (t.view.view.cam_from_world * middle).z() / camera.fx);
  return t;
}

}  // namespace

std::vector<SurfelTarget> make_targets(const std::vector<TrainingView>& views, int side,
                                       const Eigen::Vector3d& middle) {
  std::vector<SurfelTarget> targets(views.size());
  parallel_for(int(views.size()), 1,
               [&](int v) { targets[v] = make_target(views[v], side, middle); });
  return targets;
}

}  // namespace sketchsplat
