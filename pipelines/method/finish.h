// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "edges/views/lift.h"
#include "pipelines/method/add_edges.h"
#include "pipelines/options/run.h"
#include "pipelines/survey/observe.h"
#include "pipelines/survey/rounded.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// Of an edge, more probably than not.
constexpr double kProbable = 0.5;

/// A sketch with what is known of it.
struct FinishedSketch {
  Sketch sketch;                  ///< with evidence
  std::vector<Regularity> kept;   ///< relations that its strokes keep to
  std::vector<Numbers> features;  ///< per stroke: what its confidence was made of
  int unsure = 0;                 ///< strokes that were left out as less probable than asked for
  int rounded = 0;                ///< and others that were left out as rounded edges
  double edgel_sigma_px = 0;      ///< of the edgels about the strokes
};

/// Fills in what the images show of each stroke, but for the confidence.
StrokeObservation with_evidence(const EdgeWorld& world, const ReconstructOptions& options,
                                Sketch* sketch);

/// Last polish on the edgels, regularities, and the evidence. Corners in pockets and rings of
/// patterns that move by more than a pixel go back: few views see them, and others what hides them.
FinishedSketch polish_and_regularize(const WithMissing& all, const EdgeWorld& world,
                                     const MethodRun& run);

/// Fills in evidence and features. `implied`: per stroke the probability that something else than
/// the images gives it, or none. A stroke that is probable by this alone has the evidence of one
/// that no view sees.
void judge_strokes(const EdgeWorld& world, const ReconstructOptions& options,
                   const std::vector<double>& implied, FinishedSketch* finished);

/// Leaves out strokes that are rounded edges after all (rounded.h) and those of a confidence under
/// that of the options. Throws TooLittleError if none is left. Returns the new index of each
/// stroke, -1 for those left out.
std::vector<int> leave_out_doubtful(const StrokeOrigins& origins, const EdgeWorld& world,
                                    const ReconstructOptions& options, FinishedSketch* finished);

/// Regularities of strokes by their new indices (-1: gone), each once; those of one stroke go.
std::vector<Regularity> renumbered(std::vector<Regularity> kept, const std::vector<int>& now);

/// Fills the report's strokes, regularities (by curve, see curve_chain.h) and counts.
void report_sketch(const FinishedSketch& finished, const EdgeWorld& world, const RunLog& log);

}  // namespace sketchsplat
