// SPDX-License-Identifier: MIT
#include "pipelines/survey/rounded.h"

#include <cmath>

#include "pipelines/survey/round_judge.h"
#include "sketches/curve/closest.h"
#include "sketches/curve/curve.h"
#include "sketches/curve/sample.h"

namespace sketchsplat {
namespace {

constexpr double kLonger = 1.3;   // than what was chosen, of strokes that are judged anew
constexpr double kAlongPx = 2;    // of what was chosen from the stroke that it went into
constexpr double kSpacingPx = 5;  // of samples

// Length of the longest stroke of `chosen` that lies along a stroke.
double longest_along(const Sketch& sketch, int stroke, const Sketch& chosen,
                     const SampleLayout& layout, const Samples& samples, double footprint) {
  double longest = 0;
  for (int c = 0; c < chosen.size(); ++c) {
    const double length = stroke_length(chosen, c);
    if (length <= longest) continue;
    bool along = true;
    for (int i = layout.first[c]; along && i < layout.first[c + 1]; ++i)
      along = distance_to_stroke(sketch, stroke, samples.position.col(i)).distance <
              kAlongPx * footprint;
    if (along) longest = length;
  }
  return longest;
}

}  // namespace

std::vector<bool> rounded_strokes(const Sketch& sketch, const Sketch& chosen,
                                  const EdgeWorld& world, const SelectOptions& options) {
  const SampleLayout layout = plan_samples(chosen, kSpacingPx * world.footprint);
  const Samples samples = evaluate_samples(chosen, layout);
  const Observation wide = observe_rounds(sketch, world, 0);
  const RoundJudge judge(world, wide, options.round);
  std::vector<double> nats;
  for (int s = 0; s < sketch.size(); ++s) nats.push_back(judge.nats(s, nullptr));
  const double odds = options.round_odds > 0 ? options.round_odds : odds_of_round(nats);
  std::vector<bool> round;
  for (int s = 0; s < sketch.size(); ++s)
    round.push_back(nats[s] + std::log(odds) > 0 &&
                    stroke_length(sketch, s) > kLonger * longest_along(sketch, s, chosen, layout,
                                                                       samples, world.footprint));
  return round;
}

}  // namespace sketchsplat
