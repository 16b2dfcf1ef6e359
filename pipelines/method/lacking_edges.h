// SPDX-License-Identifier: MIT
#pragma once

#include "edges/views/lift.h"
#include "pipelines/detectors/detectors.h"
#include "sketches/graph/solid.h"

namespace sketchsplat {

/// What the views show of edges inside of the masks that a solid does not have.
struct LackingEdges {
  int points = 0;    ///< in space, every LiftOptions::stride_px
  double share = 0;  ///< of these and those of the solid's edges, in [0, 1]
};

/// Edgels along the solid's edges, outlines, and all whose lines of sight meet a round face, which
/// may be its shading, are explained; what is left is lifted. What the detector takes for print is
/// no edge. Without masks nothing is told from other things: none.
LackingEdges lacking_edges(const Solid& solid, const EdgeWorld& world, const Detector& detector,
                           const LiftOptions& lift);

}  // namespace sketchsplat
