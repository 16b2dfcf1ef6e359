// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sketches/graph/sketch.h"
#include "sketches/solve/similarity.h"

namespace sketchsplat {

/// Poses, from one sketch to another, in which directions that strokes of both have in common fall
/// together (lines, axes of conics), the more of their length the better, and places that many
/// pairs of like strokes vote for, centroids or boxes. The identity is always among them; a few
/// thousand at most. `fit_scale`: sizes are not comparable, that of the first is guessed, too.
std::vector<Similarity> pose_candidates(const Sketch& from, const Sketch& to, bool fit_scale);

}  // namespace sketchsplat
