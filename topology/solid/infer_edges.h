// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sketches/graph/sketch.h"
#include "topology/solid/find_surfaces.h"

namespace sketchsplat {

/// An edge that surfaces imply and no stroke shows: a line between nodes that are there, or a
/// circle.
struct ImpliedStroke {
  StrokeKind kind = StrokeKind::kLine;
  int begin = -1, end = -1;              ///< nodes of a line
  std::vector<Eigen::Vector3d> handles;  ///< of a circle
  bool smooth = false;                   ///< its surfaces touch along it: no image can show it
};

/// Rulings of cylinders and cones, and lines in which two planes meet, between neighbouring nodes
/// along them that at most two strokes of `seen` meet in: where a plane runs into a round smoothly,
/// and where an edge is too faint. And the other rim of a hole or a boss of which one is seen:
/// copies of a circle, along its axis, in planes across it. `completed`: the same nodes and
/// strokes, then what was implied before; what is there already is passed over. `surfaces` as found
/// in it; `tolerance`: of a node from a surface, world units.
std::vector<ImpliedStroke> implied_strokes(const Sketch& seen, const Sketch& completed,
                                           const std::vector<SurfaceStrokes>& surfaces,
                                           double tolerance);

}  // namespace sketchsplat
