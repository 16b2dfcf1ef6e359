// SPDX-License-Identifier: MIT
#pragma once

#include "edges/lift.h"
#include "pipelines/gap.h"
#include "sketches/sketch.h"

namespace sketchsplat {

struct RoundOptions {
  double least_turn = 0.4;  ///< share of a turn from which arcs may be all of it
  double aside_px = 1;      ///< [px] of two arcs from their common ellipse
  double circle_px = 0.5;   ///< [px] between an ellipse and the circle that it is
};

/// Most of a circle or an ellipse, in one arc or in two that share a node, is all of it if nothing
/// else ends there and the gap may hold an edge (may_hold_edge). `rounded` counts them.
Sketch round_arcs(const Sketch& sketch, const EdgeWorld& world, const RoundOptions& options,
                  const GapOptions& gap, int* rounded);

}  // namespace sketchsplat
