// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

namespace sketchsplat {

/// What all fits say. Points are 3 x N in any unit of length; what cannot be fitted (too few
/// points, all in one place, not finite; collinear where a curve is asked for) gives success =
/// false and zeros, never NaN. No fit is robust against outliers: the caller leaves them out.
struct FitQuality {
  bool success = false;
  double rms = 0;           ///< root of the (weighted) mean squared distance to the curve
  double max_distance = 0;  ///< largest distance to the curve
};

/// Total least squares line; the ends are the extreme projections. At least 2 points.
struct LineFit : FitQuality {
  Eigen::Vector3d begin = Eigen::Vector3d::Zero(), end = Eigen::Vector3d::Zero();
};
/// `weights`: N numbers >= 0, or empty (all 1); points of weight 0 are not there.
LineFit fit_line(const Eigen::Matrix3Xd& points, const Eigen::VectorXd& weights = {});

/// Circle of least squared distances in space (plane and radius at once), from a start by Taubin
/// (1991). Fitted through its curvature, so that short arcs are as well-conditioned as full
/// circles. At least 3 points, in any order.
struct CircleFit : FitQuality {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, of either sign
  double radius = 0;
};
CircleFit fit_circle(const Eigen::Matrix3Xd& points);

/// Arc of the fitted circle from the first to the last of points in order along it (neighbours less
/// than 180 deg apart). No success if they run around more than once.
struct ArcFit : FitQuality {
  Eigen::Vector3d begin = Eigen::Vector3d::Zero(), apex = Eigen::Vector3d::Zero(),
                  end = Eigen::Vector3d::Zero();
};
ArcFit fit_arc(const Eigen::Matrix3Xd& points);
/// Arc between two given ends, which only bends; points in any order, at least 1. A straight one is
/// a success with the apex on the chord.
ArcFit fit_arc(const Eigen::Matrix3Xd& points, const Eigen::Vector3d& begin,
               const Eigen::Vector3d& end);

/// Cubic through points in order along it, at least 4; collinear points give a straight cubic.
struct BezierFit : FitQuality {
  std::array<Eigen::Vector3d, 4> control = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                                            Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
};
/// An end that is given stays; one that is not starts at the first (last) point and moves with the
/// fit, at parameter 0 (1). Local minimum of the squared distances from a chord-length start.
BezierFit fit_bezier(const Eigen::Matrix3Xd& points,
                     const std::optional<Eigen::Vector3d>& begin = std::nullopt,
                     const std::optional<Eigen::Vector3d>& end = std::nullopt);

/// Ellipse of least squared distances in space, from a direct fit (Halir and Flusser 1998) in the
/// plane of the points. At least 6 points, in any order; u is the major and v the minor semi-axis.
struct EllipseFit : FitQuality {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero(), u = Eigen::Vector3d::Zero(),
                  v = Eigen::Vector3d::Zero();
};
EllipseFit fit_ellipse(const Eigen::Matrix3Xd& points);

}  // namespace sketchsplat
