// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "pipelines/bench/chart.h"
#include "pipelines/bench/row.h"

namespace sketchsplat {

/// A result of another method as its authors or others state it, not measured here.
struct PublishedResult {
  const char* method;  ///< with the edge detector it was given
  double f5;           ///< [per cent]; mean over 82 models of ABC-NEF
  double seconds;      ///< per scene
};

/// Of the tables of SketchSplat (arXiv 2503.14786) and CurveGaussian (2506.21401), which state the
/// time of a scene; on GPUs.
const std::vector<PublishedResult>& published_results();

/// Accuracy against time (logarithmic): a dot per scene in the colour of its variant, a ring for
/// the mean, the Pareto front of the means; in the first panel published results for comparison.
/// Panels: F5, F5 closer, fine F1.
Chart accuracy_chart(const std::vector<BenchRow>& rows);

}  // namespace sketchsplat
