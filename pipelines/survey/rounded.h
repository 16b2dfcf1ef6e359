// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "pipelines/survey/select.h"

namespace sketchsplat {

/// Where strokes come from.
struct StrokeOrigins {
  const Sketch& chosen;  ///< by the views (select_strokes): rounds if they surely are
  const Sketch& judged;  ///< those, and what was judged together with others as it is
};

/// Which strokes are rounded edges. Those of neither origin are that others imply, or that grew
/// longer than each stroke along them: a piece of a rounded edge may pass for an edge, all of it
/// does not.
std::vector<bool> rounded_strokes(const Sketch& sketch, const StrokeOrigins& origins,
                                  const EdgeWorld& world, const SelectOptions& options);

}  // namespace sketchsplat
