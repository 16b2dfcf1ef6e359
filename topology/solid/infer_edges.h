// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sketches/sketch.h"
#include "topology/solid/find_surfaces.h"

namespace sketchsplat {

/// A line that surfaces imply and no stroke shows, between nodes that are there.
struct ImpliedLine {
  int begin, end;  ///< nodes
  bool smooth;     ///< its surfaces touch along it: no image can show it
};

/// Rulings of cylinders and cones, and lines in which two planes meet, between neighbouring nodes
/// along them that at most two strokes of `seen` meet in: where a plane runs into a round smoothly,
/// and where an edge is too faint. `completed`: the same nodes and strokes, then lines implied
/// before; nodes that any stroke of it joins are passed over. `surfaces` as found in it;
/// `tolerance`: of a node from a surface, world units.
std::vector<ImpliedLine> implied_lines(const Sketch& seen, const Sketch& completed,
                                       const std::vector<SurfaceStrokes>& surfaces,
                                       double tolerance);

}  // namespace sketchsplat
