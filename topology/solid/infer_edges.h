// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sketches/graph/sketch.h"
#include "topology/solid/find_surfaces.h"

namespace sketchsplat {

/// An edge that surfaces imply and no stroke shows: a line or an arc between nodes that are there,
/// or a circle.
struct ImpliedStroke {
  StrokeKind kind = StrokeKind::kLine;
  int begin = -1, end = -1;              ///< nodes; -1 of a circle
  std::vector<Eigen::Vector3d> handles;  ///< as many as the kind has
  bool smooth = false;                   ///< its surfaces touch along it: no image can show it
  bool twin = false;                     ///< between two corners that both lack it
};

/// Rulings of cylinders and cones, and lines in which two planes meet, between neighbouring nodes
/// along them that at most two strokes of `seen` meet in: where a plane runs into a round smoothly,
/// and where an edge is too faint. Lines
/// between two corners that lack their third edge alike. Arcs between loose ends of arcs of one
/// circle. And the other rim of a hole or a boss of which one is seen:
/// copies of a circle, along its axis, in planes across it. `completed`: the same nodes and
/// strokes, then what was implied before; what is there already is passed over. `surfaces` as found
/// in it; `tolerance`: of a node from a surface; `slide`: of a node along its strokes, which tell
/// little of where a line runs smoothly into an arc. World units.
std::vector<ImpliedStroke> implied_strokes(const Sketch& seen, const Sketch& completed,
                                           const std::vector<SurfaceStrokes>& surfaces,
                                           double tolerance, double slide);

}  // namespace sketchsplat
