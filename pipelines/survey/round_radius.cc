// SPDX-License-Identifier: MIT
// The cylinder that lines of sight touch along a stroke.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "datasets/types/dense.h"
#include "pipelines/survey/round_judge.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kFits = 8;              // rounds of least squares
constexpr double kLeastOffPx = 0.1;   // that outlines in front of backgrounds err by, all alike
constexpr double kKnownRadius = 0.5;  // its standard deviation over itself, at most

}  // namespace

// The outlines touch a cylinder: its axis, relative to the stroke, and its radius, from a first
// one.
RoundJudge::RimFit RoundJudge::fit_rim(const std::vector<RoundSighting>& seen,
                                       double radius_px) const {
  const bool outlines = !world_.hull.empty();
  RimFit fit{Vector3d(0, 0, radius_px), Matrix3d::Zero()};
  for (int k = 0; k < kFits; ++k) {
    const bool free = k > 1;  // the radius; the axis comes first
    const double sigma = k < kFits / 2 ? 6 * sigma_ : sigma_;
    Matrix3d H = 1e-4 * Matrix3d::Identity();
    Vector3d g = Vector3d::Zero();
    for (const RoundSighting& v : seen) {
      if (outlines && !v.outline) continue;
      const double r = (v.place_px - v.row.dot(fit.x)) / sigma;
      const double w = k == 0 ? 1 : std::exp(-0.5 * r * r);
      const Vector3d row = free ? v.row : Vector3d(v.row.x(), v.row.y(), 0);
      H += w * row * row.transpose();
      g += w * row * (v.place_px - (free ? 0 : v.row.z() * radius_px));
    }
    const Vector3d next = solve_symmetric(H, g);
    if (!next.allFinite()) return {Vector3d::Zero(), H};
    fit = {free ? next : Vector3d(next.x(), next.y(), radius_px), H / (sigma * sigma)};
  }
  return fit;
}

RoundJudge::Radius RoundJudge::radius(int stroke, const EdgelFlags* others) const {
  if (!world_.has_masks()) return {};
  const std::vector<RoundSighting> seen = round_sightings(world_, wide_, stroke, others);
  Radius best;
  double most = -INFINITY;
  for (const double times : {1.0, 3.0, 9.0}) {
    const RimFit rim = fit_rim(seen, times * model_.least_radius_px);
    if (!(rim.x.z() > 0)) continue;
    double sum = 0, squares = 0;
    int touching = 0;
    for (const RoundSighting& v : seen) {
      if (!v.outline) continue;
      const double off = v.place_px - v.row.dot(rim.x);
      sum += std::log(places().near(off));
      if (std::abs(off) < 3 * sigma_) ++touching, squares += off * off;
    }
    if (touching <= 3 || sum <= most) continue;
    most = sum;
    const double off = std::max({sigma_, kLeastOffPx, std::sqrt(squares / (touching - 3))});
    best = {rim.x.z(), std::sqrt(rim.precision.inverse()(2, 2)) * off / sigma_, touching};
  }
  // Views from nearly one side tell where it is touched, not how round it is.
  return best.sigma_px < kKnownRadius * best.px ? best : Radius();
}

}  // namespace sketchsplat
