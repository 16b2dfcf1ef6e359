// SPDX-License-Identifier: MIT
#pragma once

#include "pipelines/method/finish.h"
#include "topology/solid/find_solid.h"

namespace sketchsplat {

/// A sketch whose strokes bound a solid becomes the solid's edges: those that no image shows are
/// added (unless the options are against it), strokes that were one edge seen twice, or pieces of
/// one, are one. As given if there is no solid. Doubtful strokes of `found` are renamed.
FinishedSketch complete_sketch(FinishedSketch finished, SolidSearch* found, const EdgeWorld& world,
                               const MethodRun& run);

/// Doubtful strokes by their new indices, -1 for those that are gone.
void rename_doubtful(const std::vector<int>& now, SolidSearch* found);

}  // namespace sketchsplat
