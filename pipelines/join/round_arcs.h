// SPDX-License-Identifier: MIT
#pragma once

#include "edges/views/lift.h"
#include "pipelines/survey/describe.h"
#include "pipelines/survey/gap.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// Where circles are looked for. Whether they are made is a matter of the description alone.
struct RoundOptions {
  double least_turn = 0.4;  ///< share of a turn from which arcs may be all of it
  GapOptions gap;           ///< to the whole turn
};

/// Most of a circle or an ellipse, in one arc or in two that share a node, or of a circle in two
/// that share none, is all of it if nothing else ends there and that takes fewer words: it has no
/// nodes, but an edge must run through the gap (gap_cost). The same of ellipses that are circles,
/// and of loose strokes that lie on a closed one. `described` is of the sketch and follows it;
/// `rounded` counts arcs.
Sketch round_arcs(const Sketch& sketch, const EdgeWorld& world, const RoundOptions& options,
                  Described* described, int* rounded);

}  // namespace sketchsplat
