// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "pipelines/survey/select.h"

namespace sketchsplat {

/// Which strokes are rounded edges, of those that were not chosen (select_strokes) as they are now:
/// that others imply, or that grew longer than each stroke of `chosen` along them. A piece of a
/// rounded edge may pass for an edge, all of it does not.
std::vector<bool> rounded_strokes(const Sketch& sketch, const Sketch& chosen,
                                  const EdgeWorld& world, const SelectOptions& options);

}  // namespace sketchsplat
