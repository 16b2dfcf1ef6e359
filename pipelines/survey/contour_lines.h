// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "pipelines/survey/observe.h"

namespace sketchsplat {

/// [nat] by which a line is likelier the contour of a smooth surface than an edge, because of a
/// curve that it touches, or would if it were longer by half, where that goes on smoothly: the side
/// of a cylinder between its rims. Beforehand one in ten such lines is an edge. The surface that
/// holds both is known there with its radius, and from where its contour lies near the line. Such
/// views see the contour in either case and tell nothing. Of all others that face the line few show
/// anything by accident if it is a contour, and any share of them an edge, which may be faint.
/// -infinity where no curve is touched. `keep`: strokes that count as curves; views that the hull
/// is not sure of say nothing.
double contour_nats(int line, const Sketch& sketch, const std::vector<bool>& keep,
                    const Observation& observation, const EdgeWorld& world);

}  // namespace sketchsplat
