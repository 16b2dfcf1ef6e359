// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "sketches/curve.h"
#include "sketches/solid.h"

namespace sketchsplat {

/// Signed distance of a point from a surface, positive on the side of its normal. World units;
/// smooth but on the axis. Parameters as scalars so that solvers may ask for derivatives.
template <typename T>
T signed_distance(SurfaceKind kind, const Vec3<T>& origin, const Vec3<T>& axis, const T& radius,
                  const T& slope, const T& minor_radius, const Vec3<T>& point) {
  using std::sqrt;
  const Vec3<T> from = point - origin;
  const T along = from.dot(axis);
  if (kind == SurfaceKind::kPlane) return along;
  if (kind == SurfaceKind::kSphere) return sqrt(from.squaredNorm() + T(1e-300)) - radius;
  const T out = sqrt((from - axis * along).squaredNorm() + T(1e-300));
  if (kind == SurfaceKind::kCylinder) return out - radius;
  if (kind == SurfaceKind::kCone)
    return (out - radius - slope * along) / sqrt(T(1) + slope * slope);
  const T ring = out - radius;
  return sqrt(ring * ring + along * along + T(1e-300)) - minor_radius;
}
double signed_distance(const Surface& surface, const Eigen::Vector3d& point);

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
