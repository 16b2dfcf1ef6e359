// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "pipelines/survey/select.h"

namespace sketchsplat {

/// Where strokes come from: those of neither were implied by others, or grew longer than each along
/// them.
struct StrokeOrigins {
  const Sketch& chosen;  ///< by the views (select_strokes)
  const Sketch& judged;  ///< those, and what was judged together with others as it is
};

/// Which strokes are rounded edges as they are now. A piece of one may pass for an edge, all of it
/// does not: what is of neither origin is judged anew, by the odds of these strokes. What was
/// chosen is one if it surely is, what was judged with others stays.
std::vector<bool> rounded_strokes(const Sketch& sketch, const StrokeOrigins& origins,
                                  const EdgeWorld& world, const SelectOptions& options);

}  // namespace sketchsplat
