// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <set>

#include "edges/views/lift.h"
#include "sketches/graph/sketch.h"
#include "topology/core/passes.h"

namespace sketchsplat {

/// What a word costs: the one currency in which all changes of the graph are paid.
struct Prices {
  double parameter = 3;   ///< [nat] see SegmentOptions
  double sigma_px = 0.2;  ///< [px] least standard deviation of what all views say of a place
};

/// What the images say of a sketch, and what it costs to say otherwise.
struct Described {
  DescriptionCost cost;
  StrokePoints points;  ///< where the edgels put each stroke
};
Described describe(const Sketch& sketch, const EdgeWorld& world, const Prices& prices);

/// Those of several strokes, 3 x n.
Eigen::Matrix3Xd points_of(const StrokePoints& points, const std::set<int>& strokes);

}  // namespace sketchsplat
