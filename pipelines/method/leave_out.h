// SPDX-License-Identifier: MIT
#pragma once

#include "edges/views/lift.h"
#include "pipelines/detectors/detectors.h"
#include "pipelines/options/run.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// The sketch without print: strokes of which the detector knows that most of what it knows about
/// lies on a smooth surface (Detector::judge).
Sketch drop_print(const Sketch& sketch, const EdgeWorld& world, const Detector& detector,
                  const RunLog& log);

/// The sketch without strokes of things beside the object (survey/other_things.h).
Sketch drop_things(const Sketch& sketch, const EdgeWorld& world, const RunLog& log);

}  // namespace sketchsplat
