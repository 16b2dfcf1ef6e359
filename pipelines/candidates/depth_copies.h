// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "edges/contrast/contrast_judge.h"
#include "edges/views/lift.h"
#include "pipelines/candidates/level_copies.h"

namespace sketchsplat {

/// Closed loops inside of one level that no other level has a copy of, at the depths where the
/// judge finds most, seen from anywhere or through the loop: floors of pockets and of blind holes.
/// And the edges in which walls meet, from the corners of the loop to those of its copy. `depths`:
/// adds the number of those that were tried.
std::vector<Candidate> depth_copies(const Sketch& sketch, const std::vector<Levels>& levels,
                                    const KnownCurves& known, const ContrastJudge& judge,
                                    const EdgeWorld& world, int* depths);

}  // namespace sketchsplat
