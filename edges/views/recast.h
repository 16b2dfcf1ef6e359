// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "edges/views/lift.h"

namespace sketchsplat {

/// The same edgels as other cameras with the same images see them: through their lenses (edgels
/// that a new lens cannot draw are dropped). Bounds, footprint and hull stay; make_edge_world makes
/// them anew.
EdgeWorld recast(EdgeWorld world, std::vector<View> views);

/// The world without the views that are marked; bounds, footprint and hull stay.
EdgeWorld without_views(const EdgeWorld& world, const std::vector<char>& leave);

/// What pictures of 1 / `factor` the size would show: cameras and edgels in pixels that are so much
/// larger, every factor-th edgel of a chain. All that is measured in pixels reaches so much
/// further. Masks are left out, bounds and hull stay.
EdgeWorld coarser(const EdgeWorld& world, int factor);

}  // namespace sketchsplat
