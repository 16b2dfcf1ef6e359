// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "topology/solid/choose.h"
#include "topology/solid/complete.h"
#include "topology/solid/evidence.h"
#include "topology/solid/find_solid.h"

namespace sketchsplat {

/// Strokes that lie within `reach` [world units] of others all along: they may be these, seen
/// twice. Of those that are `left` (per stroke that was seen) alone.
std::vector<Double> doubles_of(const Sketch& sketch, const std::vector<bool>& left, double reach);

/// All faces that surfaces may have between these strokes, and what they and the strokes cost
/// [nat]; `doubles` may be no edges. `weighed`: what masks and lines of sight say of each cell.
CellChoice price_cells(const Completed& all, double tolerance, const SolidOptions& options,
                       const SolidEvidence& evidence, const std::vector<Double>& doubles,
                       EvidenceOfCells* weighed);

}  // namespace sketchsplat
