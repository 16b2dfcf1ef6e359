// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "edges/surfels/model/surfel_set.h"
#include "edges/surfels/model/surfel_target.h"

namespace sketchsplat {

struct MoveOptions {
  int rounds = 6;       ///< at the most; 0: none
  int neighbours = 12;  ///< whose planes are tried
  double reach = 4;     ///< [spacings] to these
  int sources = 10;     ///< views that a patch is compared with
  double gain = 0.05;   ///< of the agreement, which is 1 at best, that makes a move worth while
};

/// Moves surfels that lie where the pictures disagree to where they agree, over distances that no
/// gradient bridges: along the ray of the view that shows most of a surfel to the plane of a
/// neighbour, whose normal it takes, round by round until none moves (planes spread as those of
/// PatchMatch stereo, Bleyer et al., BMVC 2011). Agreement is the normalised cross-correlation of a
/// 7 x 7 patch with the views beside, mean over the better half of them, for the others may be
/// hidden. Patches without contrast stay. `drawing` renders the surfels, `spacing` in world units.
/// Returns the indices of those that moved, ascending. The same for any number of threads.
std::vector<int> move_surfels(const std::vector<SurfelTarget>& targets,
                              const SurfelOptions& drawing, double spacing,
                              const MoveOptions& options, SurfelSet* set);

}  // namespace sketchsplat
