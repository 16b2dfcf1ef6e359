// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "pipelines/candidates/level_copies.h"

namespace sketchsplat {

/// Mirror images of all strokes in the planes half-way between the outermost levels.
std::vector<Candidate> mirror_copies(const Sketch& sketch, const std::vector<Levels>& levels);

/// What goes on where circles of one size and level repeat: along a line, at the fourth corner of a
/// parallelogram, and around the axis of another circle. `tolerance`: of radii and levels, world
/// units.
std::vector<Candidate> circle_patterns(const Sketch& sketch, double tolerance);

}  // namespace sketchsplat
