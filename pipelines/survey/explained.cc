// SPDX-License-Identifier: MIT
#include "pipelines/survey/explained.h"

#include <algorithm>
#include <utility>

#include "datasets/types/median.h"
#include "pipelines/survey/observe.h"

namespace sketchsplat {
namespace {

constexpr double kSpacingPx = 6;
constexpr double kUnfit = 0.3;  // times what strokes explain of the usual view

Observation look(const Sketch& sketch, const EdgeWorld& world, double reach_px) {
  MatchOptions match;
  match.reach_px = reach_px;
  match.quadratics = false;
  return observe(sketch, world, match, kSpacingPx);
}

// Number of edgels of each view that strokes lie on.
std::vector<double> edgels_on_strokes(const EdgeWorld& world, const Observation& o) {
  const int n = int(world.views.size());
  std::vector<std::vector<char>> on(n);
  for (int v = 0; v < n; ++v) on[v].resize(world.maps[v].edgels.size());
  constexpr int kHalf = int(kSpacingPx) / 2;
  for (const SampleMatch& m : o.matches.matches) {
    const int last = std::min(int(on[m.view].size()), m.edgel + kHalf);
    for (int e = std::max(0, m.edgel - kHalf); e < last; ++e) on[m.view][e] = 1;
  }
  std::vector<double> out;
  for (const auto& view : on) out.push_back(double(std::count(view.begin(), view.end(), 1)));
  return out;
}

}  // namespace

CurvePoints points_on(const Sketch& sketch, double spacing) {
  const SampleLayout layout = plan_samples(sketch, spacing);
  Samples samples = evaluate_samples(sketch, layout);
  return {std::move(samples.position), std::move(samples.tangent), layout.first};
}

EdgelFlags edgels_along(const Sketch& sketch, const EdgeWorld& world) {
  constexpr double kClosePx = 2;  // as explain() needs them
  EdgelFlags along = no_edgels(world);
  explain(world, points_on(sketch, kClosePx * world.footprint), {}, &along);
  return along;
}

Explained explained(const Sketch& sketch, const EdgeWorld& world, double reach_px) {
  const int n = int(world.views.size());
  Explained out{std::vector<double>(n), std::vector<double>(n)};
  if (sketch.size() == 0) return out;
  const Observation o = look(sketch, world, reach_px);
  const std::vector<double> on = edgels_on_strokes(world, o);
  std::vector<double> rows(n);
  for (const SampleMatch& m : o.matches.matches) ++rows[m.view];
  double all = 0, edgels = 0;
  for (int v = 0; v < n; ++v) {
    const View& view = world.views[v];
    double shown = 0, depth;
    for (int i = 0; i < o.samples.position.cols(); ++i)
      shown += view.camera.contains(view.project(o.samples.position.col(i), &depth)) && depth > 0;
    const double here = double(world.maps[v].edgels.size());
    out.edgels[v] = on[v] / std::max(1.0, here);
    out.samples[v] = rows[v] / std::max(1.0, shown);
    all += on[v], edgels += here;
  }
  out.share = all / std::max(1.0, edgels);
  return out;
}

std::vector<char> unfit_views(const Explained& shares) {
  const double edgels = kUnfit * median(shares.edgels);
  const double samples = kUnfit * median(shares.samples);
  std::vector<char> out;
  for (size_t v = 0; v < shares.edgels.size(); ++v)
    out.push_back(shares.edgels[v] < edgels && shares.samples[v] < samples);
  return out;
}

}  // namespace sketchsplat
