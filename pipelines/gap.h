// SPDX-License-Identifier: MIT
#pragma once

#include "edges/lift.h"
#include "sketches/sketch.h"

namespace sketchsplat {

struct GapOptions {
  double narrow_px = 8;      ///< [px] up to which a gap is closed where nothing is known of it
  double least_seen = 0.15;  ///< share of the sure sightings of a gap that must see an edge
  bool trusting = true;      ///< may wide gaps be closed that no view must see?
};

/// May an edge run along the curve of this kind between the parameters `t0` and `t1`, about
/// `length` (world units) apart, as far as the views can tell? Where the visual hull says that a
/// view must see it, it must be seen. Without masks only what is narrow may.
bool may_hold_edge(StrokeKind kind, const ControlPoints& curve, double t0, double t1, double length,
                   const EdgeWorld& world, const GapOptions& options);

}  // namespace sketchsplat
