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

/// The circle that a circle, an arc or an ellipse runs along to within the tolerance (world units);
/// none if it is another kind of stroke, or straight.
std::optional<CircleRim> circle_rim(const Sketch& sketch, int stroke, double tolerance);

}  // namespace sketchsplat
