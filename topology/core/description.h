// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "sketches/fit/segment.h"
#include "topology/core/passes.h"
#include "topology/core/plain_curve.h"

namespace sketchsplat {

/// Parameters of a curve between its nodes; a closed curve has none, all are its own.
constexpr int own_parameters(StrokeKind kind) {
  return num_parameters(kind) - (is_closed(kind) ? 0 : 3);
}

/// What it costs [nat] that the images put the `points` (3 x n) of a stroke where the curve is not.
double misfit(const PlainCurve& curve, const Eigen::Matrix3Xd& points,
              const DescriptionCost& options);
/// The same for points that may lie on any of some curves.
double misfit(const std::vector<PlainCurve>& curves, const Eigen::Matrix3Xd& points,
              const DescriptionCost& options);

/// Points on the strokes as they are drawn, about two footprints apart: for sketches that no images
/// belong to. Unsound strokes have none.
StrokePoints drawn_points(const Sketch& sketch, const TopologyOptions& options);

}  // namespace sketchsplat
