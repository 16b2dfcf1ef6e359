// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "edges/views/lift.h"
#include "pipelines/base/run_report.h"
#include "pipelines/stages/options.h"
#include "pipelines/survey/observe.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// [px] How far beside strokes edgels tell of cameras that may err.
constexpr double kCameraReachPx = 2;

/// First strokes by cameras that may err.
struct Posed {
  EdgeWorld world;
  Sketch sketch = {};
  double nats = 0;               ///< that the views say for the strokes, see FirstStrokes
  std::vector<char> round = {};  ///< per stroke: hardly an edge, and no witness of cameras
  RunReport report = {};         ///< of how the strokes were found, alone
};

/// Lifts and fits strokes anew, in the world as it is; none if views agree on nothing.
void find_strokes(const ReconstructOptions& options, Progress* progress, Posed* posed);

/// What views show of the strokes that are not round: where lines of sight touch a round moves with
/// the view as if cameras erred.
Observation look(const Posed& posed, double reach_px);

/// Edges of things around the object are most of what the images show then, and the share that
/// strokes explain tells nothing.
bool stands_among_things(const EdgeWorld& world);

/// Hull and bounds by the cameras as they are, where masks tell.
EdgeWorld refreshed(EdgeWorld world);

}  // namespace sketchsplat
