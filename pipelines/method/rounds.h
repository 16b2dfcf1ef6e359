// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "edges/views/lift.h"
#include "pipelines/adjust/optimize.h"
#include "pipelines/options/run.h"
#include "pipelines/survey/prior_odds.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// Rounds of moving the strokes of a world and simplifying their graph.
class Rounds {
 public:
  /// World and run must outlive it. `odds`: of the first strokes; without any, as strokes have
  /// them.
  Rounds(const EdgeWorld& world, const PriorOdds& odds, const MethodRun& run);

  /// Rounds, until the graph does not change any more or the options limit them: strokes are drawn
  /// and moved (optimize) if there are steps, weighed, and the graph is simplified; the graph that
  /// results is moved by least squares.
  Sketch until_still(Sketch sketch);

  /// Strokes of the edgels that no stroke explains (strokes_of_rest): nothing pulls at what they
  /// show. They are chosen among the others as all are; if one was, one more round follows.
  Sketch second_look(const Sketch& sketch);

 private:
  struct Round {
    Sketch sketch;
    bool changed = false;  // the graph did; positions always do
  };
  Round run_round(const Sketch& sketch);
  Round with_rest(const Sketch& sketch);

  const EdgeWorld& world_;
  const PriorOdds odds_;
  const MethodRun& run_;
  const std::vector<EdgeTarget> targets_;
};

}  // namespace sketchsplat
