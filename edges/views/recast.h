// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "edges/views/lift.h"

namespace sketchsplat {

/// The same edgels as other cameras with the same images see them: through their lenses (edgels
/// that a new lens cannot draw are dropped). Bounds, footprint and hull stay; make_edge_world makes
/// them anew.
EdgeWorld recast(EdgeWorld world, std::vector<View> views);

/// What pictures of 1 / `factor` the size would show: cameras and edgels in pixels that are so much
/// larger, every factor-th edgel of a chain. All that is measured in pixels reaches so much
/// further. Masks are left out, bounds and hull stay.
EdgeWorld coarser(const EdgeWorld& world, int factor);

}  // namespace sketchsplat
