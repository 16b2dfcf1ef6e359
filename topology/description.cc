// SPDX-License-Identifier: MIT
#include "topology/description.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sketchsplat {
namespace {

constexpr double kSpacingPx = 2;

// Middles of pieces of a curve that are about `spacing` long, no more of them than samples.
Eigen::Matrix3Xd middles(const PlainCurve& curve, double spacing) {
  const double length = sample_curve(curve).length;
  const int n = spacing > 0 ? int(std::clamp(std::ceil(length / spacing), 1.0, 256.0)) : kPieces;
  const CurveSamples samples = sample_curve(curve, 2 * n);
  Eigen::Matrix3Xd out(3, n);
  for (int i = 0; i < n; ++i) out.col(i) = samples.position.col(2 * i + 1);
  return out;
}

}  // namespace

double misfit(const PlainCurve& curve, const Eigen::Matrix3Xd& points,
              const TopologyOptions& options) {
  return misfit(std::vector<PlainCurve>{curve}, points, options);
}

double misfit(const std::vector<PlainCurve>& curves, const Eigen::Matrix3Xd& points,
              const TopologyOptions& options) {
  Eigen::VectorXd distance = Eigen::VectorXd::Constant(points.cols(), INFINITY);
  for (const PlainCurve& curve : curves) {
    const CurveSamples samples = sample_curve(curve);
    for (int i = 0; i < points.cols(); ++i)
      distance[i] = std::min(distance[i], closest_point(curve, samples, points.col(i)).distance);
  }
  // Without a footprint only what coincides is no misfit.
  const double least = std::numeric_limits<double>::min();
  return misfit(distance, std::max(options.sigma_px * options.footprint, least));
}

StrokePoints drawn_points(const Sketch& sketch, const TopologyOptions& options) {
  StrokePoints out;
  for (int s = 0; s < sketch.size(); ++s) {
    PlainCurve curve;
    curve.kind = sketch.strokes[s].kind;
    const ControlPoints c = control_points(sketch, s);
    std::copy_n(c.p.begin(), c.count, curve.p.begin());
    out.push_back(is_sound(curve) ? middles(curve, kSpacingPx * options.footprint)
                                  : Eigen::Matrix3Xd(3, 0));
  }
  return out;
}

}  // namespace sketchsplat
