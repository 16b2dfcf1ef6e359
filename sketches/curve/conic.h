// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "sketches/graph/sketch.h"

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

/// An elliptic arc by conjugate semi-diameters: centre + cos(psi) p + sin(psi) q, psi from
/// -half_angle (its begin) to half_angle (its end).
struct EllipticArcParameters {
  Eigen::Vector3d centre, p, q;
  double half_angle = 0;  ///< (0, pi) rad
  bool straight = false;  ///< rise below 1e-9 of the chord: nothing else means anything
  Eigen::Vector3d at(double psi) const { return centre + std::cos(psi) * p + std::sin(psi) * q; }
};
/// `control`: begin, apex, quarter, end.
EllipticArcParameters elliptic_arc_parameters(const ControlPoints& control);
/// Control points begin, apex, quarter, end of centre + cos(psi) p + sin(psi) q from psi0 to psi1;
/// 2e-3 < psi1 - psi0 < 6.2 rad.
ControlPoints elliptic_arc(const Eigen::Vector3d& centre, const Eigen::Vector3d& p,
                           const Eigen::Vector3d& q, double psi0, double psi1);

/// The arc of the same ellipse between the places nearest in angle to new ends, which are the ends:
/// best if they lie on the ellipse. One that would vanish or go around is moved along with its ends
/// instead.
ControlPoints elliptic_arc_between(const ControlPoints& control, const Eigen::Vector3d& begin,
                                   const Eigen::Vector3d& end);

/// Principal semi-axes of an ellipse: |major| >= |minor|, perpendicular, major x minor = u x v.
struct EllipseAxes {
  Eigen::Vector3d major, minor;
};
/// From conjugate semi-axes (centre + cos u + sin v); Rytz's problem, tan 2a = 2 u.v / (u.u - v.v).
/// `angle`, if there: a; cos(s) u + sin(s) v = cos(s - a) major + sin(s - a) minor.
EllipseAxes principal_axes(const Eigen::Vector3d& u, const Eigen::Vector3d& v,
                           double* angle = nullptr);

}  // namespace sketchsplat
