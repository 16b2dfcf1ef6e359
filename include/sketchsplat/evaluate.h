// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "sketchsplat/curves.h"

namespace sketchsplat {

/// Precision, recall and F-score at one distance, per cent.
struct ScoreLevel {
  double threshold = 0;  ///< fraction of the object's longest side
  double precision = 0, recall = 0, f = 0;
};

/// Comparison with a truth by a published protocol. Lengths are fractions of the longest side.
struct Scores {
  double accuracy = 0;             ///< mean distance from curves to truth; NaN without curves
  double completeness = 0;         ///< mean distance from truth to curves; NaN without curves
  std::vector<ScoreLevel> levels;  ///< at 0.020, 0.010, 0.005, 0.002, 0.001
};

/// `truth`: a scene folder or a file with a ground truth (docs/formats.md). `protocol`:
/// "sketchsplat", "emap" or "curvegaussian". Throws std::invalid_argument (protocol) or
/// std::runtime_error (truth).
Scores evaluate(const CurveSketch& sketch, const std::string& truth,
                const std::string& protocol = "sketchsplat");

}  // namespace sketchsplat
