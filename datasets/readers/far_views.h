// SPDX-License-Identifier: MIT
#pragma once

#include "datasets/readers/scene.h"

namespace sketchsplat {

/// Moves views from which what the cameras stand around covers less than a pixel out of the scene,
/// with a warning each: a pose so wrong would take the whole scene with it. The size of what the
/// cameras stand around is the median of their distances from their median; nothing is done with
/// fewer than three views or where most cameras stand in one place.
void leave_out_far_views(Scene* scene);

}  // namespace sketchsplat
