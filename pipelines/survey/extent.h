// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>

#include "edges/views/lift.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

struct ExtentOptions {
  double share = 0.5;        ///< of the views that see the stroke up to here must see it here
  int min_views = 3;
  double gap_price = 0;        ///< times a gap's length must be seen beyond it; 0: it is an end
  double min_length_px = 3.0;  ///< [px] shorter strokes are left as they are
  Eigen::AlignedBox3d box;     ///< ends stay in it, world units; empty: they may be anywhere
};

/// Lets every free end (a node that one stroke holds) run or retreat to where the views stop seeing
/// the stroke; edgels that another stroke explains better do not count. Of gaps inside it
/// `gap_price` says whether they are ends. Closed strokes and shared nodes stay.
Sketch fit_extents(const Sketch& sketch, const EdgeWorld& world, const ExtentOptions& options);

}  // namespace sketchsplat
