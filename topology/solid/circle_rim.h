// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>

#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// A circle as what turns about an axis.
struct CircleRim {
  Eigen::Vector3d centre, axis;  ///< axis: unit
  double radius = 0;
};

/// Do they turn about one axis, to within twice the tolerance (world units)?
bool coaxial(const CircleRim& a, const CircleRim& b, double tolerance);

/// The circle of a circle, of an arc that is not straight, or of an ellipse that keeps to within
/// the tolerance (world units) of one: its semi-axes differ by no more than twice that, and the
/// lesser one is longer than four, lest any small ellipse be a circle. None of other strokes.
std::optional<CircleRim> circle_rim(const Sketch& sketch, int stroke, double tolerance);

}  // namespace sketchsplat
