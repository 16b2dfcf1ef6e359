// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "edges/views/lift.h"
#include "pipelines/cameras/camera_fit.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// Views of which strokes explain less than of most, for they are pixels off: strokes stay, and
/// each such view looks for them up to 9 px to every side, from its pose and from the stated one.
/// Where they explain about as much then as of other views, and far more than before, the view
/// takes the new pose. How many have.
int bring_back(const Sketch& sketch, const StatedCameras& stated, const CameraPrior& prior,
               EdgeWorld* world);

}  // namespace sketchsplat
