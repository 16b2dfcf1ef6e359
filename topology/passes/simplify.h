// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "topology/core/passes.h"

namespace sketchsplat {

/// Changes made by each pass, over all rounds.
struct SimplifyCounts {
  int collinear = 0, endpoints = 0;
  int rounds = 0;  ///< including the last one, which changed nothing

  int total() const { return collinear + endpoints; }
  /// For reports: name and count of each pass, in the order in which they run.
  std::vector<std::pair<std::string, int>> named() const;
};

struct Simplified {
  Sketch sketch;
  Remap remap;  ///< from the strokes that came in
  SimplifyCounts counts;
  StrokePoints points;  ///< of the strokes of `sketch`
  bool settled = true;  ///< false if the bound on rounds was reached while things still changed
};

/// Runs both passes in rounds until nothing changes: pieces of one curve become one before their
/// short ends are taken for noise, and end points are joined last, when few are left.
Simplified simplify(const Sketch& sketch, const TopologyOptions& options,
                    const StrokePoints& points = {});

}  // namespace sketchsplat
