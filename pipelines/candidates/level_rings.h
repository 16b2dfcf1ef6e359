// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "edges/views/unexplained.h"
#include "pipelines/candidates/level_copies.h"

namespace sketchsplat {

/// Circles in the known levels that chains of edgels in at least `fewest_views` views agree on:
/// small holes, of which edgels are too few to match them without their plane. Of every direction
/// in the eight levels that hold the most strokes. `explained`: edgels that tell of something else.
std::vector<Candidate> level_rings(const std::vector<Levels>& levels, const EdgeWorld& world,
                                   const EdgelFlags& explained, int fewest_views);

}  // namespace sketchsplat
