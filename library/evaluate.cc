// SPDX-License-Identifier: MIT
#include "sketchsplat/evaluate.h"

#include <stdexcept>

#include "eval/metrics/evaluate.h"
#include "library/access.h"

namespace sketchsplat {

Scores evaluate(const CurveSketch& sketch, const std::string& truth, const std::string& protocol) {
  EvaluateOptions options;
  if (!parse_protocol(protocol, &options.protocol))
    throw std::invalid_argument("protocol: expected sketchsplat, emap or curvegaussian, found " +
                                protocol);
  const Score score =
      evaluate(prediction_of(CurveSketchAccess::sketch(sketch)), find_ground_truth(truth), options)
          .published;
  Scores out;
  out.accuracy = score.accuracy, out.completeness = score.completeness;
  for (const Level& level : score.levels)
    out.levels.push_back({level.threshold, level.precision, level.recall, level.f});
  return out;
}

}  // namespace sketchsplat
