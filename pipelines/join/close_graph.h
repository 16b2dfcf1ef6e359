// SPDX-License-Identifier: MIT
// In: strokes, and the edgels of all views. Out: strokes joined, cut and closed where that shortens
// the description. This folder may not include anything of pipelines but base and survey.
#pragma once

#include "edges/views/lift.h"
#include "pipelines/join/round_arcs.h"
#include "pipelines/survey/describe.h"
#include "pipelines/survey/gap.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// Where gaps are looked for. Whether they are closed is a matter of the description alone.
struct CloseOptions {
  bool on = true;
  double reach_px = 8;    ///< [px] that a loose end goes on, or back, to meet another stroke
  double aside_px = 2;    ///< [px] by which it may miss it
  double least_deg = 15;  ///< [deg] between strokes that meet: others run side by side
  double bridge_px = 3;   ///< [px] of the pieces of one line from it, over a gap
  RoundOptions round;     ///< of arcs that are all of their circle
  GapOptions gap;         ///< that is to be closed
};

struct Closed {
  Sketch sketch;
  int joined = 0;   ///< loose ends that met another stroke
  int split = 0;    ///< strokes that were split where another one ends on them
  int bridged = 0;  ///< lines that go on behind something
  int rounded = 0;  ///< arcs that became circles
};

/// Makes one graph of the strokes, as a part's edges are one, where that takes fewer words (nodes
/// less, misfit more, and an edge must run through every gap: gap_cost):
///   - arcs of most of a circle or an ellipse whose ends are loose are all of it (round_arcs),
///   - two pieces of one line whose facing ends are loose are the line,
///   - a loose end whose curve meets another stroke nearby ends there: in its end node, or in a new
///     node that splits it.
Closed close_graph(const Sketch& sketch, const EdgeWorld& world, const Prices& prices,
                   const CloseOptions& options);

/// Ends where one stroke alone ends, farther than `reach` (world units) from every closed one.
int count_loose_ends(const Sketch& sketch, double reach);

}  // namespace sketchsplat
