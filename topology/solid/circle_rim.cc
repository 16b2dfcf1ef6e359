// SPDX-License-Identifier: MIT
#include "topology/solid/circle_rim.h"

#include <Eigen/Geometry>

#include "sketches/curve/conic.h"
#include "sketches/curve/curve.h"

namespace sketchsplat {

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
