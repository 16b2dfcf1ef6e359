// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "edges/views/lift.h"
#include "pipelines/options/run.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// Gaps and loose ends closed where that shortens the description.
Sketch close_sketch(const Sketch& sketch, const EdgeWorld& world, const MethodRun& run);

/// A sketch with the edges that were missing.
struct WithMissing {
  Sketch sketch;
  std::vector<Eigen::Vector3d> corners;  ///< in pockets, where copies of rims end (add_missing.h)
  std::vector<ControlPoints> rings;      ///< circles of patterns and floors
};

/// Edges added that the others lead to expect and that the pictures show (add_missing.h), if they
/// are edges more probably than not, or floor and walls that bear one another out, and of no other
/// thing (drop_things). Nothing without pictures: other detectors' edgels are of something else.
WithMissing add_missing_edges(const Sketch& sketch, const EdgeWorld& world, const MethodRun& run);

}  // namespace sketchsplat
