// SPDX-License-Identifier: MIT
#pragma once

#include "edges/views/lift.h"
#include "pipelines/detectors/detectors.h"
#include "pipelines/options/run.h"
#include "topology/solid/find_solid.h"

namespace sketchsplat {

/// The solid that the strokes bound, or why there is none; see find_solid.h. None, too, if the
/// views show edges that it lacks (lacking_edges.h). Never throws for want of one.
SolidSearch close_solid(const Sketch& sketch, const EdgeWorld& world, const Detector& detector,
                        const MethodRun& run);

}  // namespace sketchsplat
