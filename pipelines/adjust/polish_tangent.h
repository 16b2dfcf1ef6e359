// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "pipelines/adjust/polish.h"
#include "pipelines/survey/describe.h"

namespace sketchsplat {

/// [rad] Joints that turn less may be tangent.
constexpr double kMostTangentTurn = 20 * M_PI / 180;
/// [nat] That a joint of arcs that turns by so little does not turn at all. All such joints of the
/// built-in parts are tangent, some hundreds (a test counts them); twenty to one leaves room for
/// parts of others.
constexpr double kTangentLogOdds = 3;

/// Polishes, and holds joints of arcs tangent where that explains the edgels as well. How far an
/// arc reaches along the line that it goes on from, edgels hardly tell, and with it they hardly
/// tell its radius: free, such joints turn by some degrees. A joint is held
/// (PolishOptions::tangent) if it turns by at most 20 degrees and the places of its strokes, as the
/// edgels have them, are explained worse by less than a parameter costs and those odds.
Sketch polish_tangent(const Sketch& sketch, const EdgeWorld& world, const PolishOptions& options,
                      const Prices& prices, Observation* last);

}  // namespace sketchsplat
