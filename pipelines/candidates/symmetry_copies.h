// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "pipelines/candidates/level_copies.h"

namespace sketchsplat {

/// What a sketch lacks of its symmetry. Turns about the axis of a circle in its middle and mirrors
/// half-way between its outermost levels are symmetries if a third of what they move, by length,
/// lies on strokes again. All images of a stroke, of which a third is known but not all, are a
/// group, from `first_group` on, the known among them, too. An arc whose images cover its circle
/// stands for the circle. `tolerance`: of axes and levels, world units; `px`: world length of a
/// pixel. `tried`: adds the number of groups.
std::vector<Candidate> symmetry_copies(const Sketch& sketch, const std::vector<Levels>& levels,
                                       const KnownCurves& known, double tolerance, double px,
                                       int first_group, int* tried);

}  // namespace sketchsplat
