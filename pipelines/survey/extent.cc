// SPDX-License-Identifier: MIT
#include "pipelines/survey/extent.h"

#include <algorithm>
#include <cmath>

#include "edges/views/match.h"
#include "pipelines/survey/observe.h"
#include "sketches/curve/conic.h"
#include "sketches/curve/curve.h"
#include "sketches/fit/ellipse_run.h"

namespace sketchsplat {
namespace {

constexpr double kOutwardPx = 16;  // how far beyond a free end is looked
constexpr int kWindow = 8;  // samples, one pixel apart, by which a view is known to see the stroke

// Samples of one stroke from t_first on, `step` apart in t.
struct Run {
  int first = 0, count = 0;  // in the common list of samples
  double t_first = 0, t_step = 0;
  int at(double t) const { return int(std::lround((t - t_first) / t_step)); }
  double t(int sample) const { return t_first + sample * t_step; }
};

// Owner of every edgel: the stroke that lies nearest to it; -1 if none does.
std::vector<std::vector<int>> owners(const Sketch& sketch, const EdgeWorld& world) {
  MatchOptions match;
  match.reach_px = 1.0;
  const Observation o = observe(sketch, world, match, 2.0);
  std::vector<std::vector<int>> owner;
  for (const EdgelMap& m : world.maps) owner.emplace_back(m.edgels.size(), -1);
  for (const SampleMatch& m : o.matches.matches) owner[m.view][m.edgel] = o.layout.stroke[m.sample];
  return owner;
}

// Last sample from the middle in direction `way` up to which the views keep seeing the stroke. Gaps
// before its present end may be crossed.
int walk(const Matches& matches, const std::vector<std::vector<int>>& owner, int stroke,
         const Run& run, int way, const std::vector<char>& outside,
         const ExtentOptions& options) {
  const int from = run.at(0.5), end = run.at(way > 0 ? 1 : 0);
  const int num_views = int(owner.size());
  std::vector<int> recent(num_views);
  std::vector<std::vector<int>> history;
  int last_good = from, bad = 0;
  double balance = 0, best = 0;
  for (int k = from; k >= 0 && k < run.count; k += way) {
    const int i = run.first + k;
    if (outside[i]) break;
    std::vector<int> here;
    for (int m = matches.first[i]; m < matches.first[i + 1]; ++m) {
      const SampleMatch& match = matches.matches[m];
      const int other = owner[match.view][match.edgel];
      if (other < 0 || other == stroke) here.push_back(match.view);
    }
    const int seen = int(std::min<size_t>(history.size(), kWindow));
    int active = 0, agree = 0;
    for (int v = 0; v < num_views; ++v) active += 2 * recent[v] > seen;
    for (int v : here) agree += seen == 0 || 2 * recent[v] > seen;
    const bool warm = int(history.size()) >= kWindow / 2;
    const bool good = agree >= options.min_views && (!warm || agree >= options.share * active);
    balance += good ? 1 : -options.gap_price;
    bad = good ? 0 : bad + 1;
    if (balance > best) best = balance, last_good = k;
    const bool inside = options.gap_price > 0 && way * (end - k) > 0;
    if (bad >= 3 && warm && !inside) break;
    if (bad > 0) continue;  // what ended the stroke does not tell who sees it
    for (int v : here) ++recent[v];
    history.push_back(here);
    if (int(history.size()) > kWindow)
      for (int v : history[history.size() - 1 - kWindow]) --recent[v];
  }
  return last_good;
}

// How far either end may be moved outwards, as a share of the length: cubics do not say how they go
// on, and an elliptic arc must not close up.
double most_growth(const Sketch& sketch, int stroke) {
  const StrokeKind kind = sketch.strokes[stroke].kind;
  if (kind == StrokeKind::kBezier) return 0.1;
  if (kind != StrokeKind::kEllipticArc) return INFINITY;
  const double turn = 2 * elliptic_arc_parameters(control_points(sketch, stroke)).half_angle;
  return turn > 0 ? std::clamp((kMostEllipseSweep / turn - 1) / 2, 0.0, 0.1) : 0.1;
}

}  // namespace

Sketch fit_extents(const Sketch& sketch, const EdgeWorld& world, const ExtentOptions& options) {
  const std::vector<int> degree = node_degrees(sketch);
  std::vector<Run> runs(sketch.size());
  std::vector<Eigen::Vector3d> position, tangent;
  CurvePoints samples;
  samples.first.push_back(0);
  for (int s = 0; s < sketch.size(); ++s) {
    const Stroke& stroke = sketch.strokes[s];
    const double length_px =
        is_closed(stroke.kind) ? 0 : stroke_length(sketch, s) / world.footprint;
    if (length_px >= options.min_length_px) {
      const double reach = std::min(kOutwardPx, most_growth(sketch, s) * length_px);
      const double before = degree[stroke.begin] == 1 ? reach : 0;
      const double after = degree[stroke.end] == 1 ? reach : 0;
      Run& run = runs[s];
      run.first = int(position.size());
      run.count = int(std::ceil(before + length_px + after)) + 1;
      run.t_first = -before / length_px;
      run.t_step = (before + length_px + after) / length_px / (run.count - 1);
      for (int k = 0; k < run.count; ++k) {
        Eigen::Vector3d p, d;
        evaluate_stroke(sketch, s, run.t(k), &p, &d);
        position.push_back(p);
        tangent.push_back(d.normalized());
      }
    }
    samples.first.push_back(int(position.size()));
  }
  samples.position.resize(3, position.size());
  samples.tangent.resize(3, position.size());
  for (size_t i = 0; i < position.size(); ++i)
    samples.position.col(i) = position[i], samples.tangent.col(i) = tangent[i];
  MatchOptions match;
  match.reach_px = 1.0;
  match.exclusive = false;
  const Matches matches = match_samples(world, samples, match);
  const std::vector<std::vector<int>> owner = owners(sketch, world);

  std::vector<char> outside(position.size());
  for (size_t i = 0; i < position.size() && !options.box.isEmpty(); ++i)
    outside[i] = !options.box.contains(position[i]);

  Sketch out = sketch;
  for (int s = 0; s < sketch.size(); ++s) {
    const Run& run = runs[s];
    if (run.count == 0) continue;
    const Stroke& stroke = sketch.strokes[s];
    double t0 = 0, t1 = 1;
    if (degree[stroke.begin] == 1) t0 = run.t(walk(matches, owner, s, run, -1, outside, options));
    if (degree[stroke.end] == 1) t1 = run.t(walk(matches, owner, s, run, +1, outside, options));
    if (!(t1 - t0 > 0.05)) continue;
    const ControlPoints c = subcurve(stroke.kind, control_points(sketch, s), t0, t1);
    out.nodes.col(stroke.begin) = c.p[0];
    out.nodes.col(stroke.end) = c.p[c.count - 1];
    for (int h = 0; h < num_handles(stroke.kind); ++h)
      out.handles.col(stroke.handle + h) = c.p[1 + h];
  }
  return out;
}

}  // namespace sketchsplat
