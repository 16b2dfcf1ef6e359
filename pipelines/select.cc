// SPDX-License-Identifier: MIT
#include "pipelines/select.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "edges/rim.h"
#include "edges/unexplained.h"
#include "pipelines/observe.h"
#include "topology/description.h"

namespace sketchsplat {
namespace {

// Of min_seen, and of the edgels: what is seen less often, and on the outline alone, may well be a
// contour.
constexpr double kSeldom = 0.25, kOutline = 0.9;

// [px] offset in half of the views of what lies still.
constexpr double kLiesStillPx = 0.12;

// Width of sharp edges in these images: lower quartile over the well supported strokes' edgels.
double sharp_width(const StrokeObservation& o, int min_views) {
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

// Number of views in which edgels that nobody owns yet are a good part of a stroke.
int claim(const StrokeObservation& o, int stroke, const EdgelFlags& owned,
          std::vector<int>* per_view) {
  int views = 0;
  std::fill(per_view->begin(), per_view->end(), 0);
  for (int i = o.layout.first[stroke]; i < o.layout.first[stroke + 1]; ++i)
    for (int m = o.matches.first[i]; m < o.matches.first[i + 1]; ++m) {
      const SampleMatch& match = o.matches.matches[m];
      if (owned[match.view][match.edgel]) continue;
      ++(*per_view)[match.view];
    }
  const int needed = std::max(1, o.strokes[stroke].samples / 5);
  for (int n : *per_view) views += n >= needed;
  return views;
}

// The edgels of a stroke are its own: those that its samples found, and their neighbours in the
// chain, which samples of another stroke on the same edge may find.
void own(const EdgeWorld& world, const Observation& o, int stroke, EdgelFlags* owned) {
  constexpr int kBeside = 1;  // samples lie two pixels apart, edgels one
  for (int i = o.matches.first[o.layout.first[stroke]];
       i < o.matches.first[o.layout.first[stroke + 1]]; ++i) {
    const SampleMatch& match = o.matches.matches[i];
    const std::vector<Edgel>& edgels = world.maps[match.view].edgels;
    const Edgel& e = edgels[match.edgel];
    const int last = std::min(int(edgels.size()) - 1, match.edgel + kBeside);
    for (int k = std::max(0, match.edgel - kBeside); k <= last; ++k)
      if (std::hypot(edgels[k].x - e.x, edgels[k].y - e.y) < 2) (*owned)[match.view][k] = 1;
  }
}

// Share of a stroke's samples that enough views see by edgels that are not flagged.
double own_cover(const Observation& o, int stroke, int min_views, const EdgelFlags& flagged) {
  int covered = 0;
  for (int i = o.layout.first[stroke]; i < o.layout.first[stroke + 1]; ++i) {
    int views = 0;
    for (int m = o.matches.first[i]; m < o.matches.first[i + 1]; ++m)
      views += !flagged[o.matches.matches[m].view][o.matches.matches[m].edgel];
    covered += views >= min_views;
  }
  return double(covered) / std::max(1, o.layout.first[stroke + 1] - o.layout.first[stroke]);
}

CurvePoints points_of(const Observation& o, int stroke) {
  const int first = o.layout.first[stroke], n = o.layout.first[stroke + 1] - first;
  return {o.samples.position.middleCols(first, n), o.samples.tangent.middleCols(first, n), {0, n}};
}

// Share of the sightings that must be in which there is an edgel; -1 if too few must be: the hull
// errs at a corner here and there.
double seen_share(const EdgeWorld& world, const Observation& o, int stroke, double min_sure) {
  constexpr int kEvery = 3;  // samples: the hull is coarse
  int sure = 0, seen = 0;
  std::vector<char> matched(world.views.size());
  for (int i = o.layout.first[stroke] + kEvery / 2; i < o.layout.first[stroke + 1]; i += kEvery) {
    std::fill(matched.begin(), matched.end(), 0);
    for (int m = o.matches.first[i]; m < o.matches.first[i + 1]; ++m)
      matched[o.matches.matches[m].view] = 1;
    for (size_t v = 0; v < world.views.size(); ++v)
      if (world.hull.surely_visible(o.samples.position.col(i), world.views[v].center_in_world())) {
        ++sure;
        seen += matched[v];
      }
  }
  const int matches =
      o.matches.first[o.layout.first[stroke + 1]] - o.matches.first[o.layout.first[stroke]];
  const bool enough = sure >= min_sure * matches / kEvery;
  return sure > 0 && enough ? double(seen) / sure : -1;
}

Verdict judge_extent(const StrokeStats& s, const SelectOptions& options) {
  if (s.length_px < options.min_length_px) return Verdict::kShort;
  return s.cover < options.min_cover ? Verdict::kUncovered : Verdict::kKept;
}

// Is this an edge of the object, or the contour of a curved surface, or an accident? Contours move
// with the view, so they scatter, stand off from view to view, and are not there where a fixed edge
// would be seen for sure. The more a stroke moves, the more often it must be seen.
Verdict judge(const StrokeStats& s, double seen, double sharp, double sigma,
              const SelectOptions& options) {
  // A few views agree by accident more easily: so they must agree better.
  const double many = std::min(1.0, 0.5 * s.views / options.min_views);
  const double scatter = s.bias_px <= kLiesStillPx
                             ? std::max(options.max_rms_px, options.still_rms_px)
                             : options.max_rms_px;
  if (s.rms_px > many * scatter + sigma) return Verdict::kScattered;
  if (s.bias_px > options.max_bias_px + sigma) return Verdict::kMoving;
  if (sharp > 0 && s.width_px > options.max_width * sharp) return Verdict::kBlurred;
  // What lies dead still in many views is no contour, though its two sides look alike in others.
  const bool suspect = seen >= 0 && seen < kSeldom * options.min_seen && s.outline > kOutline;
  const double still = (suspect ? 0.25 : 0.5) * (options.max_bias_px + sigma);
  if (s.views >= 2 * options.min_views && s.rms_px <= options.max_rms_px && s.bias_px <= still)
    return Verdict::kKept;
  const double moves = std::max(0.0, s.bias_px - sigma) / options.max_bias_px;
  if (seen >= 0 && seen < options.min_seen * (1 + moves)) return Verdict::kUnseen;
  return Verdict::kKept;
}

// Which strokes are rims of round surfaces; flags what the rims explain in all views.
std::vector<char> explain_rims(const StrokeObservation& o, const EdgeWorld& world,
                               const SelectOptions& options, EdgelFlags* explained) {
  const int n = int(o.strokes.size());
  RimOptions look;
  look.sigma_px = std::max(look.sigma_px, o.matches.sigma_px);
  std::vector<Rim> rims(n);
  std::vector<char> round(n);
#pragma omp parallel for schedule(dynamic, 1)
  for (int i = 0; i < n; ++i) {
    if (judge_extent(o.strokes[i], options) != Verdict::kKept) continue;
    rims[i] = fit_rim(world, points_of(o, i), look);
    round[i] = rims[i].is_round(world.footprint);
  }
  ExplainOptions near;
  near.reach_px = 1;  // edges may run beside a rim
  for (int i = 0; i < n; ++i)
    if (round[i]) explain_rim(world, points_of(o, i), rims[i], near, explained);
  return round;
}

}  // namespace

const char* verdict_name(Verdict verdict) {
  static const char* const names[] = {"kept",   "short",   "uncovered", "scattered",
                                      "moving", "blurred", "unseen",    "redundant"};
  return names[int(verdict)];
}

Selection select_strokes(const Sketch& sketch, const EdgeWorld& world,
                         const SelectOptions& options) {
  MatchOptions match;
  match.reach_px = 1.0;
  match.exclusive = false;
  match.quadratics = false;
  const StrokeObservation o =
      with_strokes(observe(sketch, world, match, 2.0), world, options.min_views);
  const double sharp = sharp_width(o, options.min_views);
  const double sigma = o.matches.sigma_px;
  MatchOptions lone = match;
  lone.min_run = 0;
  const Observation every = observe(sketch, world, lone, 2.0);
  std::vector<double> seen(sketch.size());
#pragma omp parallel for schedule(dynamic, 1)
  for (int i = 0; i < sketch.size(); ++i) seen[i] = seen_share(world, every, i, options.min_sure);

  std::vector<int> order(sketch.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return o.strokes[a].matches > o.strokes[b].matches; });
  EdgelFlags owned = no_edgels(world), explained = owned;
  std::vector<int> per_view(world.views.size());
  Selection result;
  result.verdicts.resize(sketch.size());
  result.stats = o.strokes;
  std::vector<bool> keep(sketch.size());
  const std::vector<int> degree = node_degrees(sketch);
  const double node = node_price(world, place_sigma_px(o, options.place_sigma_px));
  // [nat] of a stroke and of the nodes that it alone ends in.
  const auto price = [&](int i) {
    const Stroke& s = sketch.strokes[i];
    double sum = options.price * own_parameters(s.kind);
    for (int n : {s.begin, s.end}) sum += n >= 0 && degree[n] == 1 ? node : 0;
    return sum;
  };
  const std::vector<char> round = explain_rims(o, world, options, &owned);
  explained = owned;
  for (int i : order) {
    Verdict& verdict = result.verdicts[i];
    const auto judge_by = [&](const EdgelFlags& others) {
      result.stats[i] = summarise(world, o, i, options.min_views, &others);
      verdict = judge(result.stats[i], seen[i], sharp, sigma, options);
    };
    verdict = round[i] ? Verdict::kMoving : judge_extent(o.strokes[i], options);
    if (verdict != Verdict::kKept) continue;
    // Where two edges run side by side, the better one has explained its edgels already.
    const double places = own_cover(o, i, options.min_views, owned) * o.strokes[i].samples;
    if (claim(o, i, owned, &per_view) < options.min_views || kOutlierNats * places < price(i))
      verdict = Verdict::kRedundant;
    else
      judge_by(owned);
    const bool crowded = verdict == Verdict::kRedundant || verdict == Verdict::kScattered ||
                         verdict == Verdict::kMoving;
    if (crowded && claim(o, i, explained, &per_view) >= options.min_views &&
        own_cover(o, i, options.min_views, explained) >= options.min_cover)
      judge_by(explained);
    if (verdict != Verdict::kKept) continue;
    keep[i] = true;
    own(world, o, i, &owned);
    explain(world, points_of(o, i), {}, &explained);
  }
  result.sketch = keep_strokes(sketch, keep);
  int next = 0;
  for (int i = 0; i < sketch.size(); ++i) {
    result.remap.stroke.push_back(keep[i] ? next++ : -1);
    result.changes += !keep[i];
  }
  result.seen = seen;
  return result;
}

}  // namespace sketchsplat
