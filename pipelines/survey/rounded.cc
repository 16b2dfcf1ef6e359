// SPDX-License-Identifier: MIT
#include "pipelines/survey/rounded.h"

#include <cmath>

#include "pipelines/survey/round_judge.h"
#include "sketches/curve/closest.h"
#include "sketches/curve/curve.h"
#include "sketches/curve/sample.h"

namespace sketchsplat {
namespace {

constexpr double kLonger = 1.3;   // than what they came from, of strokes that have grown
constexpr double kAlongPx = 2;    // of that from the stroke that it went into
constexpr double kSpacingPx = 5;  // of samples
constexpr double kSurely = 2;     // [nat] against what was chosen

// Which strokes are no longer than one of `before` along them.
std::vector<bool> as_before(const Sketch& sketch, const Sketch& before, double footprint) {
  const SampleLayout layout = plan_samples(before, kSpacingPx * footprint);
  const Samples samples = evaluate_samples(before, layout);
  std::vector<bool> out(sketch.size(), false);
  for (int s = 0; s < sketch.size(); ++s)
    for (int c = 0; c < before.size() && !out[s]; ++c) {
      if (kLonger * stroke_length(before, c) < stroke_length(sketch, s)) continue;
      bool along = true;
      for (int i = layout.first[c]; along && i < layout.first[c + 1]; ++i)
        along =
            distance_to_stroke(sketch, s, samples.position.col(i)).distance < kAlongPx * footprint;
      out[s] = along;
    }
  return out;
}

}  // namespace

std::vector<bool> rounded_strokes(const Sketch& sketch, const StrokeOrigins& origins,
                                  const EdgeWorld& world, const SelectOptions& options) {
  const std::vector<bool> chosen = as_before(sketch, origins.chosen, world.footprint);
  const std::vector<bool> judged = as_before(sketch, origins.judged, world.footprint);
  const Observation wide = observe_rounds(sketch, world, 0);
  const RoundJudge judge(world, wide, options.round);
  std::vector<double> nats;
  for (int s = 0; s < sketch.size(); ++s) nats.push_back(judge.nats(s, nullptr));
  const double odds = options.round_odds > 0 ? options.round_odds : odds_of_round(nats);
  std::vector<bool> round;
  for (int s = 0; s < sketch.size(); ++s) {
    const double least = chosen[s] ? kSurely : judged[s] ? INFINITY : 0;
    round.push_back(nats[s] + std::log(odds) > least);
  }
  return round;
}

}  // namespace sketchsplat
