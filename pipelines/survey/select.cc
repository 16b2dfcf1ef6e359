// SPDX-License-Identifier: MIT
#include "pipelines/survey/select.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "datasets/types/parallel.h"
#include "edges/views/rim.h"
#include "edges/views/unexplained.h"
#include "pipelines/survey/observe.h"
#include "pipelines/survey/round_judge.h"
#include "topology/core/description.h"

namespace sketchsplat {
namespace {

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

// Which strokes are rims of round surfaces; flags what the rims explain in all views.
std::vector<char> explain_rims(const StrokeObservation& o, const EdgeWorld& world,
                               const SelectOptions& options, EdgelFlags* explained) {
  const int n = int(o.strokes.size());
  RimOptions look;
  look.sigma_px = std::max(look.sigma_px, o.matches.sigma_px);
  std::vector<Rim> rims(n);
  std::vector<char> round(n);
  parallel_for(n, 1, [&](int i) {
    if (o.strokes[i].length_px < options.min_length_px) return;
    rims[i] = fit_rim(world, points_of(o, i), look);
    round[i] = rims[i].is_round(world.footprint);
  });
  ExplainOptions near;
  near.reach_px = 1;  // edges may run beside a rim
  for (int i = 0; i < n; ++i)
    if (round[i]) explain_rim(world, points_of(o, i), rims[i], near, explained);
  return round;
}

// [px] A pixel, or more where cameras err: three standard deviations of what strokes stand off.
double reach_of_edgels(const Sketch& sketch, const EdgeWorld& world, MatchOptions match) {
  constexpr double kLeast = 1, kMost = 3;
  match.min_run = 0;
  match.reach_px = kMost;
  const Observation wide = observe(sketch, world, match, 4.0);
  return std::clamp(3 * scatter_px(world, wide), kLeast, kMost);
}

// As all strokes have it that are more than nothing, and no rims.
double odds_in_scene(const StrokeObservation& o, const StrokeJudge& judge, const RoundJudge& rounds,
                     const std::vector<char>& rim, const SelectOptions& options) {
  const int n = int(o.strokes.size());
  std::vector<double> nats(n, NAN);
  parallel_for(n, 1, [&](int i) {
    if (!rim[i] && o.strokes[i].length_px >= options.min_length_px &&
        judge.nats(i, nullptr) > options.least_nats)
      nats[i] = rounds.nats(i, nullptr);
  });
  nats.erase(std::remove_if(nats.begin(), nats.end(), [](double x) { return std::isnan(x); }),
             nats.end());
  return odds_of_round(nats);
}

}  // namespace

double edge_nats(double nothing, double round, double round_odds) {
  const double least = std::min(nothing, round);
  return least - std::log(std::exp(least - nothing) + round_odds * std::exp(least - round));
}

const char* verdict_name(Verdict verdict) {
  static const char* const names[] = {"kept", "short", "round", "unlikely", "redundant"};
  return names[int(verdict)];
}

Selection select_strokes(const Sketch& sketch, const EdgeWorld& world,
                         const SelectOptions& options) {
  MatchOptions match;
  match.exclusive = false;
  match.quadratics = false;
  match.reach_px = reach_of_edgels(sketch, world, match);
  const StrokeObservation o =
      with_strokes(observe(sketch, world, match, 2.0), world, options.min_views);
  MatchOptions lone = match;
  lone.min_run = 0;
  const Observation every = observe(sketch, world, lone, 2.0);
  const StrokeJudge judge(world, every, match.reach_px, o.matches.sigma_px, options.evidence);
  const Observation wide = observe_rounds(sketch, world, match.reach_px);
  const RoundJudge rounds(world, wide, options.round);

  std::vector<int> order(sketch.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return o.strokes[a].matches > o.strokes[b].matches; });
  EdgelFlags owned = no_edgels(world), explained = owned;
  std::vector<int> per_view(world.views.size());
  Selection result;
  result.verdicts.resize(sketch.size());
  result.stats = o.strokes;
  result.nats.resize(sketch.size());
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
  const auto known = [&](int i) { return !options.prior.empty() && !std::isnan(options.prior[i]); };
  const std::vector<char> round = explain_rims(o, world, options, &owned);
  result.round_odds =
      options.round_odds > 0 ? options.round_odds : odds_in_scene(o, judge, rounds, round, options);
  explained = owned;
  for (int i : order) {
    Verdict& verdict = result.verdicts[i];
    const auto judge_by = [&](const EdgelFlags& others) {
      result.stats[i] = summarise(world, o, i, options.min_views, &others);
      const double edge = judge.nats(i, &others) + (known(i) ? options.prior[i] : 0);
      const double no_round = -rounds.nats(i, &others);
      result.nats[i] = edge_nats(edge, no_round, result.round_odds);
      verdict = result.nats[i] > options.least_nats             ? Verdict::kKept
                : edge > no_round - std::log(result.round_odds) ? Verdict::kRound
                                                                : Verdict::kUnlikely;
    };
    if (o.strokes[i].length_px < options.min_length_px) verdict = Verdict::kShort;
    if (round[i]) verdict = Verdict::kRound;
    if (verdict != Verdict::kKept) continue;
    // Where two edges run side by side, the better one has explained its edgels already.
    const double places = own_cover(o, i, options.min_views, owned) * o.strokes[i].samples;
    if (!known(i) &&
        (claim(o, i, owned, &per_view) < options.min_views || kOutlierNats * places < price(i)))
      verdict =
          judge.nats(i, nullptr) > options.least_nats ? Verdict::kRedundant : Verdict::kUnlikely;
    else
      judge_by(owned);
    if (verdict != Verdict::kKept &&
        (known(i) || claim(o, i, explained, &per_view) >= options.min_views))
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
  return result;
}

}  // namespace sketchsplat
