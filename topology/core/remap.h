// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// Where the strokes of a sketch went in a pass: index in the new sketch, or -1 if removed.
/// Several old strokes may map to one new stroke (a merge).
struct Remap {
  std::vector<int> stroke;

  static Remap identity(int strokes);
  /// The remap of `first` followed by `second`.
  static Remap compose(const Remap& first, const Remap& second);
  bool is_identity() const;
};

/// Where the images put each stroke: 3 x n points along it. A stroke that was merged from others
/// has the points of all of them.
using StrokePoints = std::vector<Eigen::Matrix3Xd>;

/// What every topology pass returns.
struct PassResult {
  Sketch sketch;
  Remap remap;
  int changes = 0;      ///< merges, conversions or removals made
  StrokePoints points;  ///< of the strokes of `sketch`; none if the pass does not ask for them
};

}  // namespace sketchsplat
