// SPDX-License-Identifier: MIT
#include "datasets/synthetic/render/degrade.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "datasets/synthetic/render/noise.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

// The view with an error of standard deviation `angle` [rad] about each axis of its camera, and of
// as much of its distance from `middle` along each.
View disturbed(const View& view, const Vector3d& middle, double angle, std::uint64_t seed,
               int index) {
  Vector3d turn, shift;
  for (int axis = 0; axis < 3; ++axis) {
    turn[axis] = angle * normal(hash(seed, index, axis, 20));
    shift[axis] = angle * normal(hash(seed, index, axis, 21));
  }
  View out = view;
  Pose& pose = out.cam_from_world;
  const double distance = (pose * middle).norm();
  if (turn.norm() > 0) {
    const Eigen::Matrix3d rotation =
        Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
    pose.rotation = rotation * pose.rotation;
    pose.translation = rotation * pose.translation;
  }
  pose.translation += distance * shift;
  return out;
}

// Mean distance between where two cameras see a point [px].
double mean_shift(const std::vector<View>& a, const std::vector<View>& b,
                  const Eigen::Matrix3Xd& points) {
  const int step = std::max<int>(1, int(points.cols() / 500));
  double sum = 0;
  int count = 0;
  for (size_t k = 0; k < a.size(); ++k)
    for (int i = 0; i < points.cols(); i += step) {
      double near, far;
      const Eigen::Vector2d p = a[k].project(points.col(i), &near);
      const Eigen::Vector2d q = b[k].project(points.col(i), &far);
      if (!(near > 0 && far > 0)) continue;
      sum += (p - q).norm();
      ++count;
    }
  return count > 0 ? sum / count : 0;
}

}  // namespace

std::vector<View> stated_views(const std::vector<View>& views, const Eigen::Matrix3Xd& points,
                               const DegradeOptions& options, std::uint64_t seed) {
  std::vector<View> out = views;
  if (options.pose_noise_px > 0 && points.cols() > 0) {
    const Vector3d middle = points.rowwise().mean();
    // Along x and y of the image, a turn and a shift move points alike; the length of the sum of
    // two such pairs is Rayleigh distributed. Then what was left out (turns about the axis, shifts
    // along it, the draw itself) is measured and divided out.
    double angle = options.pose_noise_px / (views.at(0).camera.fx * std::sqrt(M_PI));
    for (int round = 0; round < 3; ++round) {
      for (size_t k = 0; k < views.size(); ++k)
        out[k] = disturbed(views[k], middle, angle, seed, int(k));
      const double shift = mean_shift(views, out, points);
      if (!(shift > 0)) break;
      angle *= options.pose_noise_px / shift;
    }
  }
  for (View& view : out) {
    view.camera.fx *= 1 + options.focal_error_percent / 100;
    view.camera.fy *= 1 + options.focal_error_percent / 100;
  }
  return out;
}

std::vector<Fate> fates(int views, const DegradeOptions& options, std::uint64_t seed) {
  std::vector<std::pair<std::uint64_t, int>> order(views);
  for (int k = 0; k < views; ++k) order[k] = {hash(seed, k, 0, 30), k};
  std::sort(order.begin(), order.end());
  std::vector<Fate> out(views, Fate::kWhole);
  const auto frames = [&](double share) { return int(std::lround(share * views)); };
  // From the two ends of one order.
  for (int i = 0; i < frames(options.truncated); ++i)
    out[order[views - 1 - i].second] = Fate::kTruncated;
  for (int i = 0; i < frames(options.missing); ++i) out[order[i].second] = Fate::kMissing;
  return out;
}

}  // namespace sketchsplat
