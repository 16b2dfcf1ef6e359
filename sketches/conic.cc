// SPDX-License-Identifier: MIT
#include "sketches/conic.h"

#include <Eigen/Geometry>
#include <cassert>
#include <cmath>

#include "sketches/curve.h"

namespace sketchsplat {

CircleParameters circle_parameters(const Sketch& sketch, int stroke) {
  const StrokeKind kind = sketch.strokes[stroke].kind;
  assert(kind == StrokeKind::kArc || kind == StrokeKind::kCircle);
  const ControlPoints c = control_points(sketch, stroke);
  CircleParameters out;
  if (kind == StrokeKind::kCircle) {
    out.centre = c.p[0];
    out.radius = c.p[1].norm();
    out.normal = c.p[1] / out.radius;
    out.angle = 2 * M_PI;
    return out;
  }
  const ArcFrame<double> f = arc_frame<double>(c.p[0], c.p[1], c.p[2]);
  out.straight = f.straight;
  out.radius = f.radius;
  out.angle = 2 * f.half_angle;
  out.centre = f.middle + f.up * (f.sagitta - f.radius);
  out.normal = f.up.cross(f.along);
  return out;
}

EllipseAxes principal_axes(const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
  const double a = 0.5 * std::atan2(2 * u.dot(v), u.squaredNorm() - v.squaredNorm());
  return {std::cos(a) * u + std::sin(a) * v, std::cos(a) * v - std::sin(a) * u};
}

}  // namespace sketchsplat
