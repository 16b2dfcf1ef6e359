// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "sketches/curve/curve.h"
#include "sketches/graph/solid.h"

namespace sketchsplat {

/// Signed distance [world units] of a point from a surface, as surface_distance of
/// sketches/graph/solid.h; extrusions end where their profiles end.
double surface_distance(const Surface& surface, const Eigen::Vector3d& point);

/// Unit normal at (or above) a point, on the side on which distances are positive.
Eigen::Vector3d surface_normal(const Surface& surface, const Eigen::Vector3d& point);

/// A surface laid out flat: right-handed about its normal, in world units but for the stretch of a
/// cone, a sphere or a torus. A sphere is laid out like a map, its poles on the axis; a torus
/// closes along both coordinates; the first one of an extrusion is the length along its profile.
class Layout {
 public:
  /// `around_tube`: the first coordinate of a torus runs around the tube instead of the axis.
  explicit Layout(const Surface& surface, bool around_tube = false);

  const Surface& surface() const { return surface_; }
  double period() const { return period_.x(); }  ///< of the first coordinate; 0: it does not close
  const Eigen::Vector2d& periods() const { return period_; }  ///< of both
  /// Second coordinate where all first ones are one point, the apex of a cone or a pole of a
  /// sphere: above (1) or below (-1); NaN if there is none.
  double pole(int side) const;
  Eigen::Vector2d flat(const Eigen::Vector3d& point) const;  ///< each in +- period / 2
  Eigen::Vector3d point(const Eigen::Vector2d& flat) const;  ///< on the surface
  /// A polyline without jumps of a period.
  Eigen::Matrix2Xd flat(const Eigen::Matrix3Xd& polyline) const;

  /// An extrusion's profile as a polyline, in a plane across the axis.
  const Eigen::Matrix2Xd& profile() const { return profile_; }

 private:
  Eigen::Vector2d flat_of_extrusion(const Eigen::Vector3d& point) const;

  Surface surface_;  // its profile moved along the axis, into a plane through the world's origin
  bool around_tube_;
  Eigen::Vector3d x_, y_;
  Eigen::Vector2d unit_ = Eigen::Vector2d::Ones();  ///< [world units / rad]
  Eigen::Vector2d period_ = Eigen::Vector2d::Zero();
  Eigen::Matrix2Xd profile_;
  Eigen::VectorXd length_;  ///< along the profile, up to each of its points
};

/// Where a segment crosses a surface: parameters in [0, 1] along it, ascending; of a wavy extrusion
/// the first few.
struct Crossings {
  static constexpr int kMost = 8;
  double t[kMost];
  int count = 0;
};
Crossings crossings(const Layout& layout, const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace sketchsplat
