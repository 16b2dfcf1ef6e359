// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "edges/views/lift.h"
#include "pipelines/options/run.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// A rounded edge: a surface, no edge.
struct Blend {
  /// [world units] with its standard deviation; 0: no outline tells, as of concave ones
  double radius = 0, sigma = 0;
  int views = 0;  ///< whose outlines tell the radius
};

struct Blends {
  Sketch curves;  ///< a stroke per blend, on its surface, that it runs along
  std::vector<Blend> blends;
};

/// What of the edgels that `sketch` does not explain is rounds rather than edges (RoundJudge), with
/// radii of at most 40 px. Of strokes side by side on one round the one counts of
/// which most outlines tell the radius.
Blends find_blends(const Sketch& sketch, const EdgeWorld& world, const ReconstructOptions& options);

}  // namespace sketchsplat
