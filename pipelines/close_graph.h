// SPDX-License-Identifier: MIT
#pragma once

#include "edges/lift.h"
#include "sketches/sketch.h"

namespace sketchsplat {

struct CloseOptions {
  double reach_px = 8;      ///< [px] that a loose end goes on, or back, to meet another stroke
  double aside_px = 1;      ///< [px] by which it may miss it
  double least_deg = 15;    ///< [deg] between strokes that meet: others run side by side
  double bridge_px = 1;     ///< [px] of the pieces of one line from it, over a gap
  double least_turn = 0.6;  ///< share of a circle from which an arc may be all of it
  double least_seen = 0.15; ///< share of the sure sightings of a gap that must see it
};

struct Closed {
  Sketch sketch;
  int joined = 0;   ///< loose ends that met another stroke
  int split = 0;    ///< strokes that were split where another one ends on them
  int bridged = 0;  ///< lines that go on behind something
  int rounded = 0;  ///< arcs that became circles
};

/// Makes one graph of the strokes, as a part's edges are one:
///   - an arc of most of a circle whose ends are loose is the circle,
///   - two pieces of one line whose facing ends are loose are the line,
///   - a loose end whose curve meets another stroke nearby ends there: in its end node, or in a new
///     node that splits it.
/// Gaps are closed only where no view contradicts: where the visual hull says that a view must see
/// the gap, it does. Without masks nothing is known of gaps: only those up to `reach_px` are closed.
Closed close_graph(const Sketch& sketch, const EdgeWorld& world, const CloseOptions& options);

}  // namespace sketchsplat
