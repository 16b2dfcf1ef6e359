// SPDX-License-Identifier: MIT
#pragma once

#include "edges/views/lift.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

struct GapOptions {
  double seen_rate = 0.35;    ///< how often a view sees an edge that nothing hides, (0, 1)
  double found_rate = 0.2;    ///< the same where nobody knows what may hide it: without masks
  double chance_rate = 0.03;  ///< how often it sees one where none is, > 0, less than both
};

/// What it costs [nat] to say that an edge runs along the curve of this kind between the parameters
/// `t0` and `t1`, about `length` (world units) apart: the likelihood ratio of what the views see
/// there that must see it by the visual hull (without masks: of all views), at most kOutlierNats
/// either way of a place, every two pixels. Negative where they see one; 0 where no view must.
double gap_cost(StrokeKind kind, const ControlPoints& curve, double t0, double t1, double length,
                const EdgeWorld& world, const GapOptions& options);

}  // namespace sketchsplat
