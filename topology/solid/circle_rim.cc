// SPDX-License-Identifier: MIT
#include "topology/solid/circle_rim.h"

#include <Eigen/Geometry>
#include <cmath>

#include "sketches/curve/conic.h"
#include "sketches/curve/curve.h"

namespace sketchsplat {

bool coaxial(const CircleRim& a, const CircleRim& b, double tolerance) {
  constexpr double kParallel = 0.999;  // cosine
  return std::abs(a.axis.dot(b.axis)) > kParallel &&
         a.axis.cross(b.centre - a.centre).norm() <= 2 * tolerance;
}

std::optional<CircleRim> circle_rim(const Sketch& sketch, int stroke, double tolerance) {
  switch (sketch.strokes[stroke].kind) {
    case StrokeKind::kCircle:
    case StrokeKind::kArc: {
      const CircleParameters c = circle_parameters(sketch, stroke);
      if (c.straight) return std::nullopt;
      return CircleRim{c.centre, c.normal, c.radius};
    }
    case StrokeKind::kEllipse: {
      const ControlPoints c = control_points(sketch, stroke);
      const EllipseAxes axes = principal_axes(c.p[1], c.p[2]);
      const double a = axes.major.norm(), b = axes.minor.norm();
      if (!(a - b <= 2 * tolerance) || !(b > 4 * tolerance)) return std::nullopt;
      return CircleRim{c.p[0], axes.major.cross(axes.minor).normalized(), (a + b) / 2};
    }
    default:
      return std::nullopt;
  }
}

}  // namespace sketchsplat
