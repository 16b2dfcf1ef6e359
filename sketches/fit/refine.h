// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>

#include "sketches/fit/fit.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// Points moved and scaled so that their mean is 0 and their root mean square distance from it 1.
struct Normalised {
  Eigen::Matrix3Xd points;
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  double scale = 1;
  double resolution = 1;  ///< rounding of the input in the new unit
  bool usable = false;    ///< enough points, finite, not all in one place
  Eigen::Vector3d restore(const Eigen::Vector3d& p) const { return shift + scale * p; }
  Eigen::Vector3d apply(const Eigen::Vector3d& p) const { return (p - shift) / scale; }
};
Normalised normalise(const Eigen::Matrix3Xd& points, int at_least);

struct RefineOptions {
  std::array<bool, 4> free = {true, true, true, true};  ///< control points that may move
  bool begin_at_first = false;  ///< the first point belongs to t = 0, wherever the curve is
  bool end_at_last = false;     ///< the last point belongs to t = 1
};
/// Moves control points so that the sum of squared distances of `points` to the curve falls to a
/// local minimum: Levenberg-Marquardt on the distances square to the curve, nearest points found
/// anew in each step (Wang et al. 2006, "Fitting B-spline curves by squared distance minimization",
/// tangent distance with damping). Points as normalise() makes them. Returns rms and max_distance.
FitQuality refine_curve(StrokeKind kind, const Eigen::Matrix3Xd& points,
                        const RefineOptions& options, ControlPoints* control);

/// Control points (centre, u, v) of an ellipse to start from: direct fit in the plane of the least
/// spread; false if there is none.
bool start_ellipse(const Normalised& n, ControlPoints* control);

/// Root mean square and largest of distances; no success if one is not finite.
FitQuality quality_of(const Eigen::VectorXd& distances);

}  // namespace sketchsplat
