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

// Whether a stroke is no longer than one of `before` that lies along it, or hardly.
bool is_as_before(const Sketch& sketch, int stroke, const Sketch& before, double footprint) {
  const SampleLayout layout = plan_samples(before, kSpacingPx * footprint);
  const Samples samples = evaluate_samples(before, layout);
  const auto along = [&](int sample) {
    return distance_to_stroke(sketch, stroke, samples.position.col(sample)).distance <
           kAlongPx * footprint;
  };
  for (int b = 0; b < before.size(); ++b) {
    if (kLonger * stroke_length(before, b) < stroke_length(sketch, stroke)) continue;
    int i = layout.first[b];
    while (i < layout.first[b + 1] && along(i)) ++i;
    if (i == layout.first[b + 1]) return true;
  }
  return false;
}

}  // namespace

std::vector<bool> rounded_strokes(const Sketch& sketch, const StrokeOrigins& origins,
                                  const EdgeWorld& world, const SelectOptions& options) {
  const std::vector<double> nats = round_nats(sketch, world, options.round);
  const double odds = options.round_odds > 0 ? options.round_odds : odds_of_round(nats);
  std::vector<bool> round;
  for (int s = 0; s < sketch.size(); ++s) {
    const double sure = nats[s] + std::log(odds);
    if (!(sure > 0))
      round.push_back(false);
    else if (is_as_before(sketch, s, origins.chosen, world.footprint))
      round.push_back(sure > kSurely);
    else
      round.push_back(!is_as_before(sketch, s, origins.judged, world.footprint));
  }
  return round;
}

}  // namespace sketchsplat
