// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "topology/core/plain_curve.h"

namespace sketchsplat {

/// Weighted points in the order of the curve that they come from.
struct Run {
  Eigen::Matrix3Xd position;  ///< 3 x n
  Eigen::VectorXd weight;     ///< n, >= 0
};

/// All points of some runs, one after the other.
Run joined(const std::vector<Run>& runs);

/// Total least squares line (principal axis), spanning the projections of all points.
/// Nothing if the points coincide.
std::optional<PlainCurve> refit_line(const std::vector<Run>& runs);

/// Circle in the principal plane of the points: algebraic start (Kasa 1976), then Gauss-Newton on
/// the radial distances. Nothing if the points lie on a line.
std::optional<PlainCurve> refit_circle(const Run& points);

/// Arc of the circle through all runs that leaves out the largest angle which no run covers; the
/// circle itself if that is at most `closing` world units long. A run must turn less than 360 deg.
std::optional<PlainCurve> refit_arc(const std::vector<Run>& runs, double closing);

/// The open curve between its own ends that fits the points (3 x n, in any order) best: an arc by
/// its sagitta, a cubic by its handles. Lines and elliptic arcs, and whatever the points do not
/// tell, stay as they are.
PlainCurve refit_between(const PlainCurve& curve, const Eigen::Matrix3Xd& points);

/// Cubic by least squares from start parameters `t` (any scale, smallest becomes 0, largest 1),
/// alternating with the parameters of the nearest points (Hoschek 1988).
std::optional<PlainCurve> refit_bezier(const Run& points, Eigen::VectorXd t);

/// Ellipse in the same way from start parameters in [0, 1]; its axes are orthogonal afterwards.
std::optional<PlainCurve> refit_ellipse(const Run& points, Eigen::VectorXd t);

/// Arc of the ellipse through all runs that leaves out the largest angle which no run covers; the
/// ellipse itself if that is at most `closing` world units long. Nothing if they turn by less than
/// kLeastEllipseSweep, or by more than kMostEllipseSweep and leave more.
std::optional<PlainCurve> refit_elliptic_arc(const std::vector<Run>& runs, double closing);

/// The same ellipse by its half axes: u the longer one, v orthogonal to it.
PlainCurve with_principal_axes(const PlainCurve& ellipse);

}  // namespace sketchsplat
