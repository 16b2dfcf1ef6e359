// SPDX-License-Identifier: MIT
#pragma once

#include "edges/views/lift.h"

namespace sketchsplat {

/// The chains with the most meaning (EdgelMap::meaning), together at most so many edgels; all if
/// nobody judged them. The look-up is built anew if something goes.
EdgelMap most_meaningful(const EdgelMap& map, double most_edgels);

/// The views' edgels that may be of the object, for the most part: those inside of where its region
/// projects, and of these the most meaningful, `most_sides` times the side of the picture (square
/// root of its area; 0: all). The world's bounds are the region's.
EdgeWorld focused(EdgeWorld world, const ObjectRegion& object, double most_sides);

}  // namespace sketchsplat
