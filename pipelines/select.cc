// SPDX-License-Identifier: MIT
#include "pipelines/select.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pipelines/observe.h"

namespace sketchsplat {
namespace {

// Width of sharp edges in these images: lower quartile over the well supported strokes' edgels.
double sharp_width(const Observation& o, int min_views) {
  std::vector<std::pair<double, double>> widths;  // width, how many edgels say so
  double total = 0;
  for (const StrokeStats& s : o.strokes) {
    if (s.views < 2 * min_views || s.matches == 0) continue;
    widths.push_back({s.width_px, double(s.matches)});
    total += s.matches;
  }
  std::sort(widths.begin(), widths.end());
  double below = 0;
  for (const auto& w : widths)
    if ((below += w.second) >= 0.25 * total) return w.first;
  return 0;
}

// Edgels of a stroke that nobody owns yet, and the views in which they are a good part of it.
struct Claim {
  int edgels = 0, views = 0;
};
Claim claim(const Observation& o, int stroke, const std::vector<std::vector<char>>& owned,
            std::vector<int>* per_view) {
  Claim c;
  std::fill(per_view->begin(), per_view->end(), 0);
  for (int i = o.layout.first[stroke]; i < o.layout.first[stroke + 1]; ++i)
    for (int m = o.matches.first[i]; m < o.matches.first[i + 1]; ++m) {
      const SampleMatch& match = o.matches.matches[m];
      if (owned[match.view][match.edgel]) continue;
      ++c.edgels;
      ++(*per_view)[match.view];
    }
  const int needed = std::max(1, o.strokes[stroke].samples / 5);
  for (int n : *per_view) c.views += n >= needed;
  return c;
}

// Shading beside a weak edge shifts it more than a strong one: up to half as much again
// is forgiven below 2 % of the range of grey per pixel.
double max_bias(const StrokeStats& s, const SelectOptions& options) {
  return options.max_bias_px * (1 + 0.5 * std::min(1.0, 0.02 / std::max(1e-6, s.strength)));
}

}  // namespace

PassResult select_strokes(const Sketch& sketch, const EdgeWorld& world,
                          const SelectOptions& options) {
  MatchOptions match;
  match.reach_px = 1.0;
  match.exclusive = false;
  const Observation o = observe(sketch, world, match, 2.0, options.min_views);
  const double sharp = sharp_width(o, options.min_views);
  const double sigma = o.matches.sigma_px;
  const double max_rms = options.max_rms_px + sigma;

  std::vector<bool> keep(sketch.size());
  std::vector<int> order(sketch.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return o.strokes[a].matches > o.strokes[b].matches; });
  std::vector<std::vector<char>> owned;
  for (const EdgelMap& m : world.maps) owned.emplace_back(m.edgels.size(), 0);
  std::vector<int> per_view(world.views.size());
  PassResult result;
  for (int i : order) {
    const StrokeStats& s = o.strokes[i];
    const Claim c = claim(o, i, owned, &per_view);
    keep[i] = c.views >= options.min_views && c.edgels >= options.min_own * s.matches &&
              s.cover >= options.min_cover && s.rms_px <= max_rms &&
              s.bias_px <= max_bias(s, options) + sigma &&
              (sharp <= 0 || s.width_px <= options.max_width * sharp) &&
              s.length_px >= options.min_length_px;
    if (!keep[i]) continue;
    for (int k = o.layout.first[i]; k < o.layout.first[i + 1]; ++k)
      for (int m = o.matches.first[k]; m < o.matches.first[k + 1]; ++m)
        owned[o.matches.matches[m].view][o.matches.matches[m].edgel] = 1;
  }
  result.sketch = keep_strokes(sketch, keep);
  int next = 0;
  for (int i = 0; i < sketch.size(); ++i) {
    result.remap.stroke.push_back(keep[i] ? next++ : -1);
    result.changes += !keep[i];
  }
  return result;
}

}  // namespace sketchsplat
