// SPDX-License-Identifier: MIT
#include "pipelines/survey/select.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "datasets/types/parallel.h"
#include "edges/views/rim.h"
#include "edges/views/unexplained.h"
#include "pipelines/survey/contour_lines.h"
#include "pipelines/survey/observe.h"
#include "pipelines/survey/prior_odds.h"
#include "pipelines/survey/round_judge.h"
#include "topology/core/description.h"

namespace sketchsplat {
namespace {

// Number of views in which edgels that nobody owns yet are a good part of a stroke.
int claim(const StrokeObservation& o, int stroke, const EdgelFlags& owned) {
  int views = 0;
  std::vector<int> per_view(owned.size());
  for (int i = o.layout.first[stroke]; i < o.layout.first[stroke + 1]; ++i)
    for (int m = o.matches.first[i]; m < o.matches.first[i + 1]; ++m) {
      const SampleMatch& match = o.matches.matches[m];
      if (owned[match.view][match.edgel]) continue;
      ++per_view[match.view];
    }
  const int needed = std::max(1, o.strokes[stroke].samples / 5);
  for (int n : per_view) views += n >= needed;
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

double odds_of_edge(const std::vector<double>& nats, bool rare) {
  constexpr double kEdges = 1, kAccidents = 5;  // known beforehand: few strokes say little
  const double odds = most_probable_odds(nats, kEdges, kAccidents);
  // Among many accidents, what the views show must do.
  return rare ? odds : std::max(odds, 1.0);
}

const char* verdict_name(Verdict verdict) {
  static const char* const names[] = {"kept", "short", "round", "unlikely", "redundant"};
  return names[int(verdict)];
}

namespace {

// Chooses strokes one after the other, as often as asked; what is observed of them once stays.
class Greedy {
 public:
  Greedy(const Sketch& sketch, const EdgeWorld& world, const SelectOptions& options)
      : sketch_(sketch),
        world_(world),
        options_(options),
        match_(match_options(sketch, world)),
        sure_(std::max(options.sure_views, options.min_views)),
        o_(with_strokes(observe(sketch, world, match_, kSpacing), world, sure_)),
        every_(observe(sketch, world, lone(match_), kSpacing)),
        judge_(world, every_, match_.reach_px, o_.matches.sigma_px, options.evidence),
        wide_(observe_rounds(sketch, world, match_.reach_px)),
        rounds_(world, wide_, options.round),
        order_(sketch.size()),
        degree_(node_degrees(sketch)),
        node_price_(node_price(world, place_sigma_px(o_, options.place_sigma_px))),
        of_rims_(no_edgels(world)),
        rim_(explain_rims(o_, world, options, &of_rims_)),
        round_odds_(options.round_odds > 0 ? options.round_odds
                                           : odds_in_scene(o_, judge_, rounds_, rim_, options)) {
    std::iota(order_.begin(), order_.end(), 0);
    std::stable_sort(order_.begin(), order_.end(),
                     [&](int a, int b) { return o_.strokes[a].matches > o_.strokes[b].matches; });
  }

  // Best supported first. Odds of an edge to nothing, beforehand.
  Selection choose(double edge_odds, double rare_odds) {
    owned_ = explained_ = of_rims_;
    log_odds_ = std::log(edge_odds);
    log_rare_odds_ = std::log(rare_odds);
    Selection result;
    result.edge_odds = edge_odds;
    result.rare_odds = rare_odds;
    result.round_odds = round_odds_;
    result.verdicts.resize(sketch_.size());
    result.stats = o_.strokes;
    result.nats.resize(sketch_.size());
    ratios_.assign(sketch_.size(), NAN);
    rare_.assign(sketch_.size(), 0);
    std::vector<bool> keep(sketch_.size());
    for (const int i : order_) {
      result.verdicts[i] = judge(i, &result);
      if (result.verdicts[i] != Verdict::kKept) continue;
      keep[i] = true;
      own(world_, o_, i, &owned_);
      explain(world_, points_of(o_, i), {}, &explained_);
    }
    drop_contours(&keep, &result);
    result.sketch = keep_strokes(sketch_, keep);
    int next = 0;
    for (int i = 0; i < sketch_.size(); ++i) {
      result.remap.stroke.push_back(keep[i] ? next++ : -1);
      result.changes += !keep[i];
    }
    return result;
  }

  // [nat] Likelihood ratios of an edge to nothing, of the strokes, rare or not, that were judged by
  // the views in the last choice and are not known from elsewhere.
  std::vector<double> ratios(bool rare) const {
    std::vector<double> out;
    for (int i = 0; i < sketch_.size(); ++i)
      if (!known(i) && !std::isnan(ratios_[i]) && bool(rare_[i]) == rare) out.push_back(ratios_[i]);
    return out;
  }

 private:
  static constexpr double kSpacing = 2;   // [px] of samples
  static constexpr int kViewsOfLine = 2;  // that make it, whatever they see

  static MatchOptions match_options(const Sketch& sketch, const EdgeWorld& world) {
    MatchOptions match;
    match.exclusive = false;
    match.quadratics = false;
    match.reach_px = reach_of_edgels(sketch, world, match);
    return match;
  }
  static MatchOptions lone(MatchOptions match) {
    match.min_run = 0;
    return match;
  }

  bool known(int i) const { return !options_.prior.empty() && !std::isnan(options_.prior[i]); }

  // [nat] of a stroke and of the nodes that it alone ends in.
  double price(int i) const {
    const Stroke& s = sketch_.strokes[i];
    double sum = options_.price * own_parameters(s.kind);
    for (const int n : {s.begin, s.end}) sum += n >= 0 && degree_[n] == 1 ? node_price_ : 0;
    return sum;
  }

  Verdict judge(int i, Selection* result) {
    if (rim_[i]) return Verdict::kRound;
    if (o_.strokes[i].length_px < options_.min_length_px) return Verdict::kShort;
    // Where two edges run side by side, the better one has explained its edgels already.
    const int views = claim(o_, i, owned_);
    Verdict verdict;
    if (known(i) || (views >= options_.min_views && is_worth_it(i, views)))
      verdict = judge_by(owned_, i, views, result);
    else
      verdict =
          judge_.nats(i, nullptr) > options_.least_nats ? Verdict::kRedundant : Verdict::kUnlikely;
    if (verdict == Verdict::kKept) return verdict;
    const int lone = claim(o_, i, explained_);
    return known(i) || lone >= options_.min_views ? judge_by(explained_, i, lone, result) : verdict;
  }

  // Lines that curves which stay tell to be contours of smooth surfaces.
  void drop_contours(std::vector<bool>* keep, Selection* result) const {
    const std::vector<bool> all = *keep;
    for (int i = 0; i < sketch_.size(); ++i) {
      if (!all[i] || known(i)) continue;
      const double nats = contour_nats(i, sketch_, all, o_, world_);
      if (!(nats > 0)) continue;
      result->verdicts[i] = Verdict::kRound;
      (*keep)[i] = false;
    }
  }

  int needed(int i, int views) const { return is_rare(i, views) ? options_.min_views : sure_; }
  bool is_rare(int i, int views) const { return !known(i) && views < sure_; }

  // What it alone explains would cost more without it.
  bool is_worth_it(int i, int views) const {
    const double places = own_cover(o_, i, needed(i, views), owned_) * o_.strokes[i].samples;
    return kOutlierNats * places >= price(i);
  }

  // By the edgels that are no others', which so many views show.
  Verdict judge_by(const EdgelFlags& others, int i, int views, Selection* result) {
    result->stats[i] = summarise(world_, o_, i, needed(i, views), &others);
    rare_[i] = is_rare(i, views);
    ratios_[i] = judge_.nats(i, &others);
    if (rare_[i] && sketch_.strokes[i].kind == StrokeKind::kLine && ratios_[i] > 0)
      ratios_[i] *= std::max(0, views - kViewsOfLine) / double(std::max(1, views));
    const double odds = rare_[i] ? log_rare_odds_ : log_odds_;
    const double edge = ratios_[i] + (known(i) ? options_.prior[i] : odds);
    const double no_round = -rounds_.nats(i, &others);
    result->nats[i] = edge_nats(edge, no_round, round_odds_);
    if (result->nats[i] > options_.least_nats) return Verdict::kKept;
    return edge > no_round - std::log(round_odds_) ? Verdict::kRound : Verdict::kUnlikely;
  }

  const Sketch& sketch_;
  const EdgeWorld& world_;
  const SelectOptions& options_;
  const MatchOptions match_;
  const int sure_;
  const StrokeObservation o_;
  const Observation every_;
  const StrokeJudge judge_;
  const Observation wide_;
  const RoundJudge rounds_;
  std::vector<int> order_;
  const std::vector<int> degree_;
  const double node_price_;
  EdgelFlags of_rims_;
  const std::vector<char> rim_;
  const double round_odds_;
  // Of the strokes that were chosen so far, and of rims.
  EdgelFlags owned_, explained_;
  double log_odds_ = 0, log_rare_odds_ = 0;
  std::vector<double> ratios_;  // [nat] of an edge to nothing; NaN: not judged
  std::vector<char> rare_;      // of those that were judged
};

}  // namespace

Selection select_strokes(const Sketch& sketch, const EdgeWorld& world,
                         const SelectOptions& options) {
  Greedy greedy(sketch, world, options);
  greedy.choose(1, 1);  // which tells the likelihood ratios of what no better stroke explains
  const double rare_odds = odds_of_edge(greedy.ratios(true), true);
  return greedy.choose(
      options.edge_odds > 0 ? options.edge_odds : odds_of_edge(greedy.ratios(false)), rare_odds);
}

}  // namespace sketchsplat
