// SPDX-License-Identifier: MIT
// In: a sketch, and the pictures. Out: edges that the sketch leads to expect and the pictures show.
// This folder may not include anything of pipelines but base and survey.
#pragma once

#include <vector>

#include "edges/contrast/contrast_judge.h"
#include "pipelines/candidates/candidate.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

struct MissingOptions {
  bool on = true;
  double false_strokes = 0.05;  ///< per scene, of all candidates together
  ContrastOptions contrast;
};

struct MissingEdges {
  /// With the strokes that were added, after the others, without those that they run along.
  Sketch sketch;
  std::vector<double> nats;   ///< of each that was added
  std::vector<int> group;     ///< group index of each added stroke, or -1
  std::vector<double> known;  ///< [nat] of each group: that they are edges, by those known before
  std::vector<Eigen::Vector3d> corners;  ///< where those of groups end, but on known strokes
  std::vector<ControlPoints> rings;      ///< circles of groups
  int candidates = 0;                    ///< that were judged
};

/// Adds the edges that the rest of the sketch leads to expect and that the pictures show. A
/// candidate is added if its likelihood ratio outweighs the number of candidates over the false
/// strokes that are tolerated, if its pieces are shown, not a part of it alone, and if copies of it
/// that are moved aside say less: best first, and each takes what it explains from the others.
/// Floor and walls of a pocket, the walls of a hole, or the holes of a bolt circle are there or
/// not, all together.
MissingEdges add_missing(const Sketch& sketch, const EdgeWorld& world,
                         const MissingOptions& options);

}  // namespace sketchsplat
