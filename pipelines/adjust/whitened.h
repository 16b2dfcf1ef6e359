// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "pipelines/survey/observe.h"
#include "sketches/solve/refine_sketch.h"

namespace sketchsplat {

/// The quadratics of what was seen in squared standard deviations of the edgels, and of what they
/// leave unknown: `floor_px` of every place, and what single views get wrong of a whole stroke.
SampleQuadratics whitened(const StrokeObservation& seen, double floor_px, double footprint);

/// The same quadratics, at samples of the sketch that were moved there. `cost` becomes what the way
/// cost.
SampleQuadratics moved_to(const Samples& to, const Samples& from, const SampleQuadratics& q,
                          double* cost);

}  // namespace sketchsplat
