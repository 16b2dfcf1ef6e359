// SPDX-License-Identifier: MIT
#include "pipelines/survey/observe.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <utility>

#include "datasets/types/dense.h"
#include "datasets/types/median.h"
#include "sketches/solve/covariance.h"

namespace sketchsplat {
namespace {

constexpr double kStillPx = 0.25;

constexpr int kPlacing = 3;          // views that place a sample
constexpr double kPlaceReach = 1.5;  // [px] of an edgel, and of the place, from the stroke

}  // namespace

Observation observe_places(const Sketch& sketch, const EdgeWorld& world) {
  MatchOptions match;
  match.reach_px = kPlaceReach;
  return observe(sketch, world, match, 2.0);
}

double place_sigma_px(const Observation& o, double least_px) {
  return std::max(least_px, 0.5 * o.matches.sigma_px);
}

double node_price(const EdgeWorld& world, double sigma_px) {
  if (world.bounds.isEmpty() || !(world.footprint > 0)) return 0;
  const double size_px = world.bounds.diagonal().norm() / world.footprint;
  return 3 * std::log(std::max(1.0, size_px / sigma_px));
}

Measured measure(const Observation& o, int stroke, double footprint) {
  const int first = o.layout.first[stroke], n = o.layout.first[stroke + 1] - first;
  Measured out{o.samples.position.middleCols(first, n), std::vector<char>(n, 0)};
  for (int k = 0; k < n; ++k) {
    const int i = first + k;
    if (o.matches.views_of(i) < kPlacing) continue;
    const Eigen::Vector3d t = o.samples.tangent.col(i);
    Eigen::Vector3d move = -solve_symmetric(o.matches.information[i], o.matches.slope.col(i));
    move -= move.dot(t) * t;
    if (!move.allFinite() || move.norm() > kPlaceReach * footprint) continue;
    out.point.col(k) += move;
    out.placed[k] = 1;
  }
  return out;
}

CurvePoints points_of(const Observation& o, int stroke) {
  const int first = o.layout.first[stroke], n = o.layout.first[stroke + 1] - first;
  return {o.samples.position.middleCols(first, n), o.samples.tangent.middleCols(first, n), {0, n}};
}

Observation without_strokes(Observation o, const std::vector<char>& leave) {
  Matches kept;
  kept.sigma_px = o.matches.sigma_px;
  kept.first.push_back(0);
  for (int i = 0; i < o.layout.size(); ++i) {
    const auto all = o.matches.matches.begin();
    if (!leave[o.layout.stroke[i]])
      kept.matches.insert(kept.matches.end(), all + o.matches.first[i],
                          all + o.matches.first[i + 1]);
    kept.first.push_back(int(kept.matches.size()));
  }
  o.matches = std::move(kept);
  return o;
}

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
    if (!distances.empty()) bias.push_back(std::abs(float(median(distances))));
  s.views = int(bias.size());
  s.bias_px = median(bias);
  s.rms_px = s.matches ? std::sqrt(squares / s.matches) : 0;
  s.still = s.matches ? double(still) / s.matches : 0;
  s.outline = s.matches ? double(outline) / s.matches : 0;
  s.cover = s.samples ? double(covered) / s.samples : 0;
  s.width_px = median(width);
  s.strength = median(strength);
  return s;
}

namespace {

// More would be noise, and take room in the file.
double six_digits(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.5e", x);
  return std::strtod(text, nullptr);
}

}  // namespace

Observation observe(const Sketch& sketch, const EdgeWorld& world, const MatchOptions& options,
                    double spacing_px) {
  Observation o;
  o.reach_px = options.reach_px;
  o.layout = plan_samples(sketch, spacing_px * world.footprint);
  o.samples = evaluate_samples(sketch, o.layout);
  o.matches = match_samples(
      world,
      {o.samples.position, o.samples.tangent, o.layout.first, sample_curvatures(sketch, o.layout)},
      options);
  return o;
}

StrokeObservation with_strokes(Observation observation, const EdgeWorld& world, int min_views) {
  StrokeObservation out{std::move(observation), {}};
  for (int i = 0; i + 1 < int(out.layout.first.size()); ++i)
    out.strokes.push_back(summarise(world, out, i, min_views, nullptr));
  return out;
}

void record_evidence(const StrokeObservation& o, const EdgeWorld& world, double reach_px,
                     Sketch* sketch) {
  std::vector<Sighting> sightings;
  sightings.reserve(o.matches.matches.size());
  for (const SampleMatch& m : o.matches.matches)
    sightings.push_back({m.sample, m.view, m.edgel,
                         distance_gradient(world, m, o.samples.position.col(m.sample)),
                         m.distance_px});
  CovarianceOptions options;
  options.reach_px = reach_px;
  const std::vector<StrokeCovariance> covariance =
      stroke_covariances(*sketch, o.layout, sightings, options);
  for (int i = 0; i < sketch->size(); ++i) {
    const StrokeStats& s = o.strokes[i];
    Evidence& e = sketch->evidence[i];
    e.opacity = s.cover;
    e.support_views = s.views;
    e.rms_px = s.rms_px;
    e.bias_px = s.bias_px;
    e.sigma = covariance[i].sigma;
    e.determined = covariance[i].determined;
    e.covariance.clear();
    for (double c : upper_triangle(covariance[i].matrix)) e.covariance.push_back(six_digits(c));
    std::set<int> views;
    for (int m = o.matches.first[o.layout.first[i]]; m < o.matches.first[o.layout.first[i + 1]];
         ++m)
      views.insert(o.matches.matches[m].view);
    e.views.assign(views.begin(), views.end());
  }
}

}  // namespace sketchsplat
