// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "edges/views/lift.h"
#include "pipelines/base/run_report.h"
#include "pipelines/options/run.h"
#include "pipelines/survey/observe.h"
#include "pipelines/survey/prior_odds.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// [px] How far beside strokes edgels tell of cameras that may err.
constexpr double kCameraReachPx = 2;
/// [px] between places of strokes that cameras are compared by.
constexpr double kCameraSpacingPx = 6;
/// Of the edgels: strokes that explain less may be accidents.
constexpr double kLowShare = 0.4;

/// The first strokes of a world.
struct FirstStrokes {
  Sketch sketch;
  double nats = 0;  ///< sum of the likelihood ratios [nat] by which they were chosen (select.h)
  PriorOdds odds;   ///< as all strokes had them that they were chosen from
};

/// Lifts edgels and fits strokes by the cameras as they are. Throws TooLittleError if views agree
/// on nothing.
using StrokeFit = std::function<FirstStrokes(const EdgeWorld& world, const MethodRun& run)>;

/// First strokes by cameras that may err.
struct Posed {
  EdgeWorld world;
  Sketch sketch = {};
  double nats = 0;               ///< that the views say for the strokes, see FirstStrokes
  PriorOdds odds = {};           ///< see FirstStrokes
  std::vector<char> round = {};  ///< per stroke: hardly an edge, and no witness of cameras
  RunReport report = {};         ///< of how the strokes were found, alone
};

/// Fits strokes anew, in the world as it is; none if views agree on nothing.
using Refit = std::function<void(Posed*)>;
/// By this fit; `log` is told of it, but for what belongs into the report, which is the posed's.
Refit refit_by(const StrokeFit& fit, const MethodRun& run);

/// What views show of the strokes that are not round: where lines of sight touch a round moves with
/// the view as if cameras erred.
Observation look(const Posed& posed, double reach_px);

/// Edges of things around the object are most of what the images show then, and the share that
/// strokes explain tells nothing.
bool stands_among_things(const EdgeWorld& world);

/// Hull and bounds by the cameras as they are, where masks tell.
EdgeWorld refreshed(EdgeWorld world);

}  // namespace sketchsplat
