// SPDX-License-Identifier: MIT
#pragma once

#include "edges/views/lift.h"
#include "pipelines/survey/describe.h"
#include "pipelines/survey/gap.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// Where splices are looked for. Whether they are made is a matter of the description alone.
struct SpliceOptions {
  double aside_px = 1;   ///< [px] between two strokes that run along the same edge
  double turn_deg = 20;  ///< [deg] between their tangents there
  double bend_deg = 45;  ///< [deg] of the way over a gap from the tangent of either end
  GapOptions gap;
};

struct Spliced {
  Sketch sketch;
  int overlaps = 0;  ///< pairs of ends that were cut where they overlapped
  int gaps = 0;      ///< cubics that were added
};

/// Makes chains of the strokes of one edge: where two loose ends (nodes that one stroke holds) run
/// past one another along the same curve, both are cut in the middle of what they share; where they
/// face one another over a gap no longer than either stroke, a cubic goes on from both, if what the
/// views see in the gap pays for it. The narrowest first. Two lines over a gap are left to
/// close_graph.
Spliced splice(const Sketch& sketch, const EdgeWorld& world, const Prices& prices,
               const SpliceOptions& options);

}  // namespace sketchsplat
