// SPDX-License-Identifier: MIT
#include "pipelines/survey/confidence.h"

#include <algorithm>
#include <cmath>

#include "datasets/types/parallel.h"
#include "sketches/curve/curve.h"

namespace sketchsplat {
namespace {

// Median over the strokes, weighted by their edgels.
double typical(const StrokeObservation& o, double StrokeStats::*member) {
  std::vector<std::pair<double, int>> values;
  double total = 0;
  for (const StrokeStats& s : o.strokes)
    if (s.matches > 0) values.push_back({s.*member, s.matches}), total += s.matches;
  std::sort(values.begin(), values.end());
  double below = 0;
  for (const auto& [value, weight] : values)
    if ((below += weight) >= 0.5 * total) return value;
  return 0;
}

double over(double a, double b) { return b > 0 ? a / b : 1; }

// Directions in which a shape of this kind can move across itself.
int freedom(StrokeKind kind) {
  switch (kind) {
    case StrokeKind::kLine: return 4;
    case StrokeKind::kArc:
    case StrokeKind::kCircle: return 6;
    case StrokeKind::kEllipse:
    case StrokeKind::kEllipticArc: return 8;
    case StrokeKind::kBezier: return 10;
  }
  return 1;
}

}  // namespace

Numbers StrokeFeatures::named() const {
  return {{"views", views},       {"view_share", view_share}, {"cover", cover},
          {"support", support},
          {"rms_px", rms_px},     {"bias_px", bias_px},       {"still", still},
          {"scatter", scatter},   {"width", width},           {"contrast", contrast},
          {"outline", outline},   {"length_px", length_px},   {"joined", joined},
          {"sigma", sigma},       {"determined", determined}};
}

std::vector<StrokeFeatures> stroke_features(const Sketch& sketch, const EdgeWorld& world,
                                            const StrokeObservation& observation) {
  const double width = typical(observation, &StrokeStats::width_px);
  const double strength = typical(observation, &StrokeStats::strength);
  const double rms = typical(observation, &StrokeStats::rms_px);
  const double extent = largest_extent(sketch);
  const std::vector<int> degree = node_degrees(sketch);
  std::vector<StrokeFeatures> out(sketch.size());
  parallel_for(sketch.size(), 1, [&](int i) {
    const StrokeStats& s = observation.strokes[i];
    const Stroke& stroke = sketch.strokes[i];
    StrokeFeatures& f = out[i];
    f.views = s.views;
    f.view_share = double(s.views) / double(world.views.size());
    f.cover = s.cover;
    f.support = s.views > 0 ? double(s.matches) / (double(s.samples) * s.views) : 0;
    f.rms_px = s.rms_px, f.bias_px = s.bias_px, f.still = s.still;
    f.scatter = over(s.rms_px, rms);
    f.width = over(s.width_px, width);
    f.contrast = over(s.strength, strength);
    f.outline = s.outline;
    f.length_px = s.length_px;
    f.joined =
        is_closed(stroke.kind) ? 1 : 0.5 * ((degree[stroke.begin] > 1) + (degree[stroke.end] > 1));
    f.sigma = extent > 0 ? 1000 * sketch.evidence[i].sigma / extent : 0;
    f.determined = double(sketch.evidence[i].determined) / freedom(stroke.kind);
  });
  return out;
}

// The numbers are from
//   eval/calibrate_confidence.py --binary build/pipelines/sketchsplat --work DIR (commit ac10b3a)
// which makes 150 scenes of 30 built-in parts (plain, textured, 8 views, glossy from above, wrong
// poses), fits on 20 parts and prints reliability and Brier score on the other 10. It chooses at
// most five of the features; scatter, length, cover, width and the like add nothing to these.
double probability_of_edge(const StrokeFeatures& f, bool outlines) {
  const double contrast = std::log2(std::clamp(f.contrast, 1.0 / 32, 4.0));
  double x;
  if (outlines) {
    const double sigma = std::log2(f.determined > 0 ? std::clamp(f.sigma, 1.0 / 32, 32.0) : 32);
    x = 5.992 * f.outline - 1.595 * sigma - 1.007 * contrast + 2.414 * f.joined +
        4.198 * f.support - 6.389;
  } else {
    x = 11.274 * f.view_share - 9.635 * std::min(f.rms_px, 1.0) + 10.565 * f.support +
        2.818 * f.joined - 0.628 * contrast - 14.069;
  }
  return 1 / (1 + std::exp(-x));
}

void record_confidence(const std::vector<StrokeFeatures>& features, Sketch* sketch) {
  const bool outlines = std::any_of(features.begin(), features.end(),
                                    [](const StrokeFeatures& f) { return f.outline > 0; });
  for (int i = 0; i < sketch->size(); ++i)
    sketch->evidence[i].confidence = probability_of_edge(features[i], outlines);
}

Sketch keep_confident(const Sketch& sketch, double least) {
  std::vector<bool> keep;
  for (const Evidence& e : sketch.evidence) keep.push_back(!(e.confidence < least));
  return keep_strokes(sketch, keep);
}

}  // namespace sketchsplat
