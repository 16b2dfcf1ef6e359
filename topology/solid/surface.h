// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "sketches/curve/curve.h"
#include "sketches/graph/solid.h"

namespace sketchsplat {

/// Unit normal at (or above) a point: out of a plane along its axis, else away from the axis, the
/// centre, or the circle of centres.
Eigen::Vector3d surface_normal(const Surface& surface, const Eigen::Vector3d& point);

/// A surface laid out flat: right-handed about its normal, in world units but for the stretch of a
/// cone. Spheres and tori have no such coordinates here.
class Layout {
 public:
  explicit Layout(const Surface& surface);

  double period() const { return period_; }  ///< of the first coordinate; 0: it does not close
  Eigen::Vector2d flat(const Eigen::Vector3d& point) const;  ///< first one in +- period / 2
  Eigen::Vector3d point(const Eigen::Vector2d& flat) const;  ///< on the surface
  /// A polyline without jumps of a period.
  Eigen::Matrix2Xd flat(const Eigen::Matrix3Xd& polyline) const;

 private:
  Surface surface_;
  Eigen::Vector3d x_, y_;
  double unit_ = 1;  ///< [world units / rad]
  double period_ = 0;
};

/// Where a segment crosses a surface: parameters in [0, 1] along it, ascending; at most two.
struct Crossings {
  double t[2];
  int count = 0;
};
Crossings crossings(const Surface& surface, const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace sketchsplat
