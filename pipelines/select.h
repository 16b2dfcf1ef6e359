// SPDX-License-Identifier: MIT
#pragma once

#include "edges/lift.h"
#include "sketches/sketch.h"
#include "topology/remap.h"

namespace sketchsplat {

struct SelectOptions {
  int min_views = 4;          ///< that must see a stroke by edgels no better stroke explains
  double min_own = 0.5;       ///< share of its edgels that no better stroke explains
  double min_cover = 0.5;     ///< share of its length that min_views views see
  double max_rms_px = 0.35;   ///< [px] scatter of its edgels, beyond that of the scene
  double max_bias_px = 0.25;  ///< [px] offset from view to view: a contour that moves with the view
  double max_width = 1.3;     ///< width of its edgels over that of the scene's sharp edges
  double min_length_px = 4.0;  ///< [px]
};

/// Keeps the fewest strokes that explain the edgels: best supported first, a stroke stays if enough
/// of its edgels, in enough views, are explained by no stroke before it, and if it lies still in
/// space (contours of curved surfaces move with the view) and is as sharp as edges here are.
PassResult select_strokes(const Sketch& sketch, const EdgeWorld& world,
                          const SelectOptions& options);

}  // namespace sketchsplat
