// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "datasets/truth/ground_truth.h"
#include "eval/metrics/metrics.h"
#include "eval/metrics/prediction.h"
#include "eval/metrics/structure.h"
#include "sketches/graph/solid_comparison.h"

namespace sketchsplat {

/// What is done to the predicted samples before they are compared:
///   sketchsplat    nothing (SketchSplat, EdgeGaussians)
///   emap           averaged in 256^3 voxels over [-1, 1]^3
///   curvegaussian  averaged in 256^3 voxels over [0, 1]^3
enum class Protocol { kSketchSplat, kEmap, kCurveGaussian };
const char* protocol_name(Protocol protocol);
bool parse_protocol(const std::string& name, Protocol* protocol);  ///< false if there is none

struct EvaluateOptions {
  Protocol protocol = Protocol::kSketchSplat;
};

/// A curve that stands out for its errors.
struct CurveScore {
  std::string name;  ///< index in its file; joined edges "3+4"
  std::string type;  ///< of an edge as the truth calls it; a stroke's kind or empty
  double length = 0;
  double share = 0;           ///< of its length within 0.005 of the other side, per cent
  double worst = 0;           ///< largest distance to the other side; infinite if that is empty
  Eigen::Matrix3Xd polyline;  ///< 3 x N, world units
};

/// How good predicted edges are. Lengths are fractions of the object's longest side
/// (times 1000: the "mm" of the published tables); shares are per cent.
struct Evaluation {
  Protocol protocol = Protocol::kSketchSplat;
  std::string prediction_path, truth_path;
  int lines = 0, curves = 0;  ///< predicted primitives
  /// The published protocol: prediction every 0.005, truth every 0.005 in its CAD file's units,
  /// float32; at 0.020, 0.010, 0.005 as published, and at 0.002 and 0.001.
  Score published;
  /// Prediction uniform in arc length, truth every 0.0005: levels at 0.005, 0.002, 0.001 with a
  /// prediction every 0.001; accuracy and completeness with a prediction every 0.005.
  Score fine;
  Structure structure;      ///< strokes against true edges, smooth continuations joined
  bool has_curves = true;   ///< false: the truth is samples only, `fine` uses these, no `structure`
  bool has_strokes = true;  ///< false: the prediction is points of no stroke, no `structure`
  bool has_visibility = false;  ///< the truth says what can be seen (by two views or more)
  /// At most five each, none of them perfect: true edges with the least recall (all of them, smooth
  /// continuations joined), strokes with the least precision; then by length, longest first.
  std::vector<CurveScore> worst_edges, worst_strokes;
  std::vector<CurveScore> strokes;       ///< all of them in their order, without their polylines
  std::optional<SolidComparison> solid;  ///< of the solid with the true part, by whoever can
};

/// Compares a prediction with the ground truth. Both are brought to the unit cube first if the
/// object's longest side is not 1. Throws InputError if the truth holds no edge.
Evaluation evaluate(const Prediction& prediction, const GroundTruth& truth,
                    const EvaluateOptions& options = {});

}  // namespace sketchsplat
