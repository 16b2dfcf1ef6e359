// SPDX-License-Identifier: MIT
#pragma once

#include <utility>
#include <vector>

#include "topology/solid/cells.h"

namespace sketchsplat {

/// Pairs of cells (ascending) that run through one another away from their borders: at most one of
/// them bounds the solid. `tolerance`: how far a cell must reach on both sides of the other, world
/// units.
std::vector<std::pair<int, int>> crossing_cells(const std::vector<SurfaceStrokes>& surfaces,
                                                const std::vector<Cell>& cells, double tolerance);

}  // namespace sketchsplat
