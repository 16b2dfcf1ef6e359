// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sketches/graph/sketch.h"
#include "topology/solid/find_surfaces.h"
#include "topology/solid/infer_edges.h"

namespace sketchsplat {

/// A sketch in which the two rims of an extruded free-form outline are copies of one another, piece
/// by piece: as they were measured they are not even cut into the same pieces.
struct MatchedRims {
  Sketch sketch;
  std::vector<std::vector<int>> now;     ///< per stroke as it was, strokes of `sketch`
  std::vector<SurfaceStrokes> surfaces;  ///< extrusions, one per pair of pieces
  std::vector<ImpliedStroke> rulings;    ///< between ends of pieces that no stroke joins yet
};

/// Rims are plane chains of ellipses, elliptic arcs and cubics between nodes in which others end;
/// of two in parallel planes that lie over one another one is replaced by copies of the other.
/// `tolerance`: of a curve from the copy that takes its place, world units.
MatchedRims match_rims(const Sketch& sketch, double tolerance);

}  // namespace sketchsplat
