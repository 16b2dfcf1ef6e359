// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// Derivative of a point of a curve, at t in [0, 1], by its control points (order: StrokeKind; x y
/// z each); columns of control points that the kind has not are zero.
Eigen::Matrix<double, 3, 12> curve_jacobian(StrokeKind kind, const ControlPoints& controls,
                                            double t);

}  // namespace sketchsplat
