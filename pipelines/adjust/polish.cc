// SPDX-License-Identifier: MIT
#include "pipelines/adjust/polish.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sketches/solve/refine_sketch.h"

namespace sketchsplat {
namespace {

constexpr double kStopPx = 0.002;  // no sample moved farther: done

}  // namespace

Sketch polish(const Sketch& sketch, const EdgeWorld& world, const PolishOptions& options,
              Observation* last) {
  Sketch s = sketch;
  double sigma = 0;
  for (int round = 0; round < options.rounds && s.size() > 0; ++round) {
    if (round > 0 && options.deadline.passed()) break;
    MatchOptions match;
    match.exclusive = match.exclusive_between = options.exclusive;
    const bool coarse = round < std::min(2, options.rounds / 2);
    match.reach_px =
        coarse ? options.reach_px : std::max(options.final_reach_px, options.final_reach * sigma);
    match.max_bias = coarse ? 0 : std::max(options.bias_px, 2 * sigma);
    Observation o = observe(s, world, match, options.spacing_px);
    sigma = o.matches.sigma_px;
    RefineSketchOptions refine;
    refine.smooth_angle = options.smooth_deg * M_PI / 180;
    refine.tangent = options.tangent;
    refine.smooth_weight = std::pow(sigma / (options.smooth_sigma_deg * M_PI / 180), 2);
    const RefineSketchResult refined =
        refine_sketch(s, o.layout, {o.matches.information, o.matches.slope}, refine);
    const Samples moved = evaluate_samples(refined.sketch, o.layout);
    const double step = (moved.position - o.samples.position).colwise().norm().maxCoeff();
    s = refined.sketch;
    if (last) *last = std::move(o);
    if (!coarse && step < kStopPx * world.footprint) break;
  }
  return s;
}

}  // namespace sketchsplat
