// SPDX-License-Identifier: MIT
#pragma once

#include "pipelines/adjust/polish.h"
#include "pipelines/survey/describe.h"

namespace sketchsplat {

/// [nat] That a joint of arcs that turns little does not turn at all: of 299 joints of arcs with
/// arcs or lines, and nothing else, that the built-in parts have 286 are tangent, and 13 turn by
/// more than 60 degrees.
constexpr double kTangentLogOdds = 3;

/// Polishes, and holds joints of arcs tangent where that explains the edgels as well. How far an
/// arc reaches along the line that it goes on from, edgels hardly tell, and with it they hardly
/// tell its radius: free, such joints turn by some degrees for a tenth of a pixel. A joint is held
/// (PolishOptions::tangent) if it turns by at most 20 degrees and the places of its strokes, as the
/// edgels have them, are explained worse by less than a parameter costs and those odds.
Sketch polish_tangent(const Sketch& sketch, const EdgeWorld& world, const PolishOptions& options,
                      const Prices& prices, Observation* last);

}  // namespace sketchsplat
