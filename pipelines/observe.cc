// SPDX-License-Identifier: MIT
#include "pipelines/observe.h"

#include <algorithm>
#include <cmath>

#include "sketches/curve.h"

namespace sketchsplat {
namespace {

constexpr double kStillPx = 0.25;

double median(std::vector<float>* values) {
  if (values->empty()) return 0;
  const size_t k = values->size() / 2;
  std::nth_element(values->begin(), values->begin() + k, values->end());
  return (*values)[k];
}

}  // namespace

StrokeStats summarise(const EdgeWorld& world, const Observation& o, int stroke, int min_views,
                      const std::vector<std::vector<char>>* ignored) {
  StrokeStats s;
  std::vector<std::vector<float>> by_view(world.views.size());
  std::vector<float> width, strength;
  double squares = 0;
  int covered = 0, outline = 0, still = 0;
  for (int i = o.layout.first[stroke]; i < o.layout.first[stroke + 1]; ++i) {
    ++s.samples;
    s.length_px += o.layout.length[i] / world.footprint;
    covered += o.matches.views_of(i) >= min_views;
    for (int m = o.matches.first[i]; m < o.matches.first[i + 1]; ++m) {
      const SampleMatch& match = o.matches.matches[m];
      if (ignored && (*ignored)[match.view][match.edgel]) continue;
      const Edgel& e = world.maps[match.view].edgels[match.edgel];
      by_view[match.view].push_back(match.distance_px);
      squares += double(match.distance_px) * match.distance_px;
      width.push_back(e.width);
      strength.push_back(e.strength);
      outline += e.outline;
      still += std::abs(match.distance_px) < kStillPx;
      ++s.matches;
    }
  }
  std::vector<float> bias;
  for (std::vector<float>& distances : by_view)
    if (!distances.empty()) bias.push_back(std::abs(float(median(&distances))));
  s.views = int(bias.size());
  s.bias_px = median(&bias);
  s.rms_px = s.matches ? std::sqrt(squares / s.matches) : 0;
  s.still = s.matches ? double(still) / s.matches : 0;
  s.outline = s.matches ? double(outline) / s.matches : 0;
  s.cover = s.samples ? double(covered) / s.samples : 0;
  s.width_px = median(&width);
  s.strength = median(&strength);
  return s;
}

Observation observe(const Sketch& sketch, const EdgeWorld& world, const MatchOptions& options,
                    double spacing_px, int min_views) {
  Observation o;
  o.layout = plan_samples(sketch, spacing_px * world.footprint);
  o.samples = evaluate_samples(sketch, o.layout);
  o.matches =
      match_samples(world, {o.samples.position, o.samples.tangent, o.layout.first}, options);
  for (int i = 0; i < sketch.size(); ++i)
    o.strokes.push_back(summarise(world, o, i, min_views, nullptr));
  return o;
}

void record_evidence(const Observation& observation, Sketch* sketch) {
  for (int i = 0; i < sketch->size(); ++i) {
    const StrokeStats& s = observation.strokes[i];
    Evidence& e = sketch->evidence[i];
    e.opacity = s.cover;
    e.support_views = s.views;
    e.rms_px = s.rms_px;
    // The weakest direction across the curve, averaged over its samples.
    double information = 0;
    for (int k = observation.layout.first[i]; k < observation.layout.first[i + 1]; ++k) {
      const Eigen::Vector3d t = observation.samples.tangent.col(k);
      const Eigen::Matrix3d& H = observation.matches.information[k];
      information += 0.5 * (H.trace() - t.dot(H * t));
    }
    e.sigma = information > 0 ? std::max(s.rms_px, 1e-3) / std::sqrt(information) : 0;
  }
}

}  // namespace sketchsplat
