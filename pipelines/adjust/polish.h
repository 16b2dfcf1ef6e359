// SPDX-License-Identifier: MIT
#pragma once

#include "pipelines/base/deadline.h"
#include "pipelines/survey/observe.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

struct PolishOptions {
  int rounds = 6;             ///< of matching and least squares
  double spacing_px = 3.0;    ///< [px] between samples
  double reach_px = 1.5;      ///< [px] of a match in the first rounds
  double final_reach_px = 1;  ///< [px] in the others, at least
  double final_reach = 4;     ///< the same, in standard deviations of the edgels
  double bias_px = 0.4;   ///< [px] a view that sees a stroke this far to one side sees another edge
  bool exclusive = true;  ///< an edgel belongs to the stroke that lies nearest to it
  double smooth_deg = 8;  ///< [deg] joints of cubics that turn less are smooth; 0: none
  double smooth_sigma_deg =
      0.2;                    ///< [deg] standard deviation of what is left between their tangents
  std::vector<char> tangent;  ///< of nodes: is it a tangent joint that is held? Empty: none is
  Deadline deadline;          ///< no second round after it
};

/// Moves the strokes onto the edgels of all views: match, then least squares with a robust weight
/// (iteratively reweighted biweight), again and again until nothing moves. `last`, if given,
/// becomes what was matched before the last move; it stays as it is if there is no round.
Sketch polish(const Sketch& sketch, const EdgeWorld& world, const PolishOptions& options,
              Observation* last = nullptr);

}  // namespace sketchsplat
