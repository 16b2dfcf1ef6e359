// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "edges/contrast/contrast_judge.h"
#include "pipelines/candidates/level_rings.h"

namespace sketchsplat {

/// Circles that repeat around an axis: rings of one size in one level, at equal distances from the
/// axis of a circle of the sketch and at equal angles, of which at least half, and three, are among
/// `rings` or in the sketch. Those of one pattern are a group, from `first_group` on, seen from
/// either side of their plane as the judge finds likelier. `tolerance`: of radii, distances and
/// levels, world units. `tried`: adds the number of patterns.
std::vector<Candidate> ring_patterns(const Sketch& sketch, const std::vector<LevelRing>& rings,
                                     double tolerance, const EdgeWorld& world,
                                     const ContrastJudge& judge, int first_group, int* tried);

}  // namespace sketchsplat
