// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace sketchsplat {

/// Ellipse of least squares through an ordered run of points, as conjugate semi-diameters: the
/// points lie near centre + cos(angle) p + sin(angle) q, see below for the angle.
struct EllipseRun {
  bool ok = false;
  Eigen::Vector3d centre, p, q;
  Eigen::VectorXd angle;     ///< [rad] of the place nearest to each point, unwrapped
  Eigen::VectorXd distance;  ///< of every point from the ellipse
  double sweep() const { return angle.size() ? angle[angle.size() - 1] - angle[0] : 0.0; }
  Eigen::Vector3d at(double psi) const { return centre + std::cos(psi) * p + std::sin(psi) * q; }
};

/// `points`: 3 x n in order, neighbours less than half a turn apart; `weights`: n numbers >= 0 or
/// empty (all 1). Direct fit (Halir and Flusser 1998), then Gauss-Newton on the distances in space
/// (tangent distance: Wang et al. 2006). Not ok: less than 8 points, no ellipse, one more slender
/// than 1 : 20 or longer than 50 times the spread of the points. The points may be several runs,
/// one after the other; then `angle` grows or falls along each.
EllipseRun ellipse_through_runs(const Eigen::Matrix3Xd& points,
                                const Eigen::VectorXd& weights = {});

/// Less of an ellipse lies as well on others; the chord of more is too short to tell the width of
/// the ellipse and its plane (elliptic arcs know both from it).
constexpr double kLeastEllipseSweep = 0.8, kMostEllipseSweep = 5.2;  // [rad]

/// The same of one run, whose angle grows; not ok if it turns by less than kLeastEllipseSweep.
EllipseRun ellipse_along(const Eigen::Matrix3Xd& points);

}  // namespace sketchsplat
