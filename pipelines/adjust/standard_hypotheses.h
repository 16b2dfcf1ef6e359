// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "pipelines/adjust/regularize.h"

namespace sketchsplat {

enum class LengthKind { kDiameter, kRadius, kPlaneDistance, kLineDistance };
const char* length_name(LengthKind kind);  ///< "diameter", "plane distance", ...

/// A length of a sketch that could be a standard one.
struct LengthHypothesis {
  LengthKind kind = LengthKind::kDiameter;
  std::vector<int> strokes;  ///< ascending: that have it, or that lie in the two planes
  /// That say it, with distance 0 or a radius of 0: equal radius, or apart. The first stands for
  /// all, scale 1: its residual is the length (the radius, of a diameter) in world units.
  std::vector<Relation> relations;
  double factor() const { return kind == LengthKind::kDiameter ? 2 : 1; }
};

/// Lengths that a drawing would state of a sketch that keeps to these regularities: radii of arcs
/// and diameters of circles (and of arcs of half a turn and more), one for all that share it;
/// distances of neighbouring and of the outermost of parallel planes; the same of parallel lines of
/// one plane, where no planes say it. `zero_radius`: shared quantity that is fixed at 0.
std::vector<LengthHypothesis> length_hypotheses(const Sketch& sketch, const Regularized& regular,
                                                int zero_radius);

}  // namespace sketchsplat
