// SPDX-License-Identifier: MIT
#include "topology/core/description.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sketches/curve/sample.h"

namespace sketchsplat {
namespace {

constexpr double kSpacingPx = 2;

}  // namespace

double misfit(const PlainCurve& curve, const Eigen::Matrix3Xd& points,
              const DescriptionCost& options) {
  return misfit(std::vector<PlainCurve>{curve}, points, options);
}

double misfit(const std::vector<PlainCurve>& curves, const Eigen::Matrix3Xd& points,
              const DescriptionCost& options) {
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
  StrokePoints out(sketch.size(), Eigen::Matrix3Xd(3, 0));
  std::vector<bool> sound(sketch.size());
  for (int s = 0; s < sketch.size(); ++s) sound[s] = is_sound(plain_curve(sketch, s));
  const Sketch kept = keep_strokes(sketch, sound);
  double spacing = kSpacingPx * options.footprint;
  if (!(spacing > 0))
    for (int s = 0; s < kept.size(); ++s)
      spacing += stroke_length(kept, s) / (kPieces * double(kept.size()));
  const SampleLayout layout = plan_samples(kept, spacing);
  const Samples samples = evaluate_samples(kept, layout);
  for (int s = 0, k = 0; s < sketch.size(); ++s) {
    if (!sound[s]) continue;
    out[s] = samples.position.middleCols(layout.first[k], layout.first[k + 1] - layout.first[k]);
    ++k;
  }
  return out;
}

}  // namespace sketchsplat
