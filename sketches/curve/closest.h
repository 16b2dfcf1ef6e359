// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// The point of a curve that is nearest to a given one.
struct ClosestPoint {
  Eigen::Vector3d position;
  double t = 0;         ///< curve parameter in [0, 1]
  double distance = 0;  ///< world units
};

/// Nearest point of the curve with these control points (order: StrokeKind). Closed forms for
/// lines, arcs and circles; bisection for ellipses (Eberly, "Distance from a Point to an Ellipse");
/// for cubics the best local minimum between 33 samples, refined by Newton's method.
/// Of several nearest points, one; finite for every finite input, degenerate curves included.
ClosestPoint closest_on_curve(StrokeKind kind, const Eigen::Vector3d* control,
                              const Eigen::Vector3d& point);

/// The same for a stroke of a sketch.
ClosestPoint distance_to_stroke(const Sketch& sketch, int stroke, const Eigen::Vector3d& point);

}  // namespace sketchsplat
