// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "edges/image/detect.h"

namespace sketchsplat {

/// Edgels of a run that is left of a chain: fewer have no direction.
inline constexpr int kShortestRun = 3;

/// The runs of append_runs() alone, of the same picture, without a look-up and without its mask;
/// `where`, if given, becomes where they were.
EdgelMap runs_of(const EdgelMap& map, const std::vector<char>& keep, int min_chain,
                 std::vector<int>* where = nullptr);

/// Like build_lookup(), but for the distances: pixels that have no edgel hold -1.
void find_nearest(EdgelMap* map, double reach_px);

}  // namespace sketchsplat
