// SPDX-License-Identifier: MIT
#pragma once

#include "pipelines/stages/stages.h"
#include "topology/solid/find_solid.h"

namespace sketchsplat {

/// A sketch whose strokes bound a solid becomes the solid's edges: those that no image shows are
/// added (unless the options are against it), strokes that were one edge seen twice, or pieces of
/// one, are one. As given if there is no solid.
FinishedSketch complete_sketch(FinishedSketch finished, const SolidSearch& found,
                               const EdgeWorld& world, const ReconstructOptions& options,
                               RunReport* report, Progress* progress);

}  // namespace sketchsplat
