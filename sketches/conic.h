// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "sketches/sketch.h"

namespace sketchsplat {

/// An arc or a circle as CAD programs state it.
struct CircleParameters {
  Eigen::Vector3d centre;
  Eigen::Vector3d normal;  ///< unit; the stroke runs counter-clockwise about it
  double radius = 0;       ///< world units
  double angle = 0;        ///< (0, 2 pi] rad
  bool straight = false;   ///< sagitta below 1e-9 of the chord: only angle = 0 means something
};
/// Of a stroke of kind arc or circle.
CircleParameters circle_parameters(const Sketch& sketch, int stroke);

/// Principal semi-axes of an ellipse: |major| >= |minor|, perpendicular, major x minor = u x v.
struct EllipseAxes {
  Eigen::Vector3d major, minor;
};
/// From conjugate semi-axes (centre + cos u + sin v); Rytz's problem, tan 2a = 2 u.v / (u.u - v.v).
EllipseAxes principal_axes(const Eigen::Vector3d& u, const Eigen::Vector3d& v);

}  // namespace sketchsplat
