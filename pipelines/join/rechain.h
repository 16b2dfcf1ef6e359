// SPDX-License-Identifier: MIT
#pragma once

#include "edges/views/lift.h"
#include "sketches/fit/segment.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

struct RechainOptions {
  double gap_px = 6;      ///< [px] between ends that continue one another
  double turn_deg = 25;   ///< [deg] between their tangents
  double sigma_px = 0.2;  ///< [px] least standard deviation of what all views say of a place
};

struct Rechained {
  Sketch sketch;
  int changes = 0;  ///< chains that were described anew
};

/// Follows strokes from end to end while one continues another smoothly and nothing else meets
/// there, asks the edgels where the whole chain runs, and cuts it anew into the curves of shortest
/// description (cut_run). A chain changes only if its description becomes shorter. Ends of chains
/// stay where they are; new joints are shared nodes.
Rechained rechain(const Sketch& sketch, const EdgeWorld& world, const SegmentOptions& segment,
                  const RechainOptions& options);

}  // namespace sketchsplat
