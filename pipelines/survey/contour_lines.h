// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "pipelines/survey/observe.h"

namespace sketchsplat {

/// [nat] by which a line is likelier the contour of a smooth surface than an edge, because of a
/// curve that it touches, or would if it were longer by half, where that goes on smoothly: the side
/// of a cylinder between its rims. Beforehand one in ten such lines is an edge. The surface that
/// holds both is known there with its radius, and from where its contour lies near the line: from
/// these views alone a contour is seen, an edge from every view that faces it. Rates of what is
/// seen are unknown and integrated over. -infinity where no curve is touched. `keep`: strokes that
/// count as curves; views that the hull is not sure of say nothing.
double contour_nats(int line, const Sketch& sketch, const std::vector<bool>& keep,
                    const Observation& observation, const EdgeWorld& world);

}  // namespace sketchsplat
