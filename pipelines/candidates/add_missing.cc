// SPDX-License-Identifier: MIT
#include "pipelines/candidates/add_missing.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "edges/contrast/alarm_threshold.h"
#include "edges/views/rim.h"
#include "edges/views/unexplained.h"
#include "pipelines/candidates/judged_candidates.h"
#include "pipelines/survey/explained.h"

namespace sketchsplat {
namespace {

constexpr double kShownShare = 0.75;  // of the pieces that must be shown
constexpr int kPasses = 3;
constexpr int kRingViews = 3, kFewestRingViews = 2;  // that agree on a ring, at first and at last
constexpr double kGroup = 2;          // times the nats of one, that all of a group must have
constexpr double kShows = 1;          // [nat] of one of a group that is there
constexpr double kAgainst = -2;       // [nat] of one of a group that is not there after all
constexpr double kBeside = 0.4;       // of the nats of a candidate that copies aside may get
constexpr double kGroupBeside = 0.6;  // of a group: short edges, moved aside, meet neighbours

EdgelFlags explained_by(const CurvePoints& strokes, const EdgeWorld& world) {
  EdgelFlags explained = no_edgels(world);
  explain(world, strokes, {}, &explained);
  return explained;
}

// Not a part of it alone; and half of it by more than one view can say.
bool all_of_it_shows(const ContrastEvidence& e, double accident) {
  int shown = 0, sure = 0;
  for (const double nats : e.piece_nats) shown += nats > 0, sure += nats > -std::log(accident);
  const double pieces = double(e.piece_nats.size());
  return shown >= kShownShare * pieces && sure >= 0.5 * pieces;
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

// Each of most of them, not a few for all.
bool most_show(const std::vector<double>& nats) {
  const auto shown = std::count_if(nats.begin(), nats.end(), [](double x) { return x > kShows; });
  return double(shown) >= kShownShare * double(nats.size());
}

// The contour of a round surface is no edge, though many views show it near one place.
bool is_rim(const EdgeWorld& world, const CurvePoints& points, double least) {
  const Rim rim = fit_rim(world, points, {});
  return rim.nats > least || rim.is_round(world.footprint);
}

// One pass over all candidates of the sketch as it is, to which it adds.
class Pass {
 public:
  Pass(const EdgeWorld& world, const MissingOptions& options, int ring_views,
       std::vector<CurvePoints>* refused, MissingEdges* out)
      : world_(world),
        options_(options),
        strokes_(points_on(out->sketch, world.footprint)),
        explained_(explained_by(strokes_, world)),
        judge_(world, strokes_, explained_, options.contrast),
        all_(judge_candidates(out->sketch, world, explained_, judge_, ring_views, refused)),
        least_(alarm_threshold(all_.nulls, all_.singles + double(all_.refused),
                               options.false_strokes / kPasses)),
        out_(out) {}

  // The number of strokes that it adds.
  int run() {
    out_->candidates += all_.tests();
    std::vector<std::pair<double, int>> groups;  // the likeliest first
    for (const auto& [number, group] : all_.groups) groups.push_back({-at_first(group), number});
    std::sort(groups.begin(), groups.end());
    for (const auto& [nats, number] : groups) add_group(all_.groups[number]);
    std::vector<int> order(all_.singles);
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return all_.nats[a] > all_.nats[b]; });
    for (const int i : order) {
      if (!(all_.nats[i] > least_)) break;
      add_single(i);
    }
    append_strokes(added_, &out_->sketch);
    return added_.size();
  }

 private:
  // What speaks for a group, if its members together get so much. Of a pattern those that are known
  // tell how likely the others are beforehand, of a pocket each counts as what a view shows.
  static double told_of(const CandidateGroup& group, double nats) {
    if (!group.pattern) return nats + sum(group.known) + sum(group.known_floor);
    return nats +
           std::log((double(group.known.size()) + 0.5) / (double(group.members.size()) + 0.5));
  }

  // At a first look, before anything is added.
  double at_first(const CandidateGroup& group) const {
    double nats = 0;
    for (const int i : group.members) nats += all_.nats[i];
    return told_of(group, nats);
  }

  // Of likelihood ratios of no edges one in exp(x) exceeds x; what one view shows by accident it
  // may show along several of a group: they count as two.
  double least_of(const CandidateGroup& group) const {
    const double tests =
        group.pattern ? all_.patterns : all_.depths + double(all_.groups.size()) - all_.patterns;
    const double one = std::log(std::max(1.0, tests) * kPasses / options_.false_strokes);
    return group.pattern && group.members.size() < 2 ? one : kGroup * one;
  }

  bool is_known(const CurvePoints& points) const {
    const double px = world_.footprint;
    return KnownCurves(added_, px, kKnownPx * px).share(points) > kKnownShare;
  }

  void add(int i, double nats, int group) {
    judge_.take(all_.points[i]);
    append(all_.candidates[i], &added_);
    out_->nats.push_back(nats);
    out_->group.push_back(group);
    const Candidate& c = all_.candidates[i];
    if (group >= 0 && c.kind == StrokeKind::kCircle) out_->rings.push_back(c.curve);
    if (group < 0 || is_closed(c.kind)) return;
    for (const Eigen::Vector3d& end : {c.curve.p[0], c.curve.p[c.curve.count - 1]}) {
      const Eigen::Matrix3Xd& nodes = out_->sketch.nodes;
      if ((nodes.colwise() - end).colwise().norm().minCoeff() > world_.footprint)
        out_->corners.push_back(end);
    }
  }

  // They are there or not, all together.
  void add_group(const CandidateGroup& group) {
    const double least = least_of(group);
    if (group.members.empty() || !(at_first(group) > least)) return;
    double beside = 0;
    std::vector<double> nats, walls = group.known, floor = group.known_floor;
    for (const int i : group.members) {
      const std::vector<Window>& windows = windows_of(all_.candidates[i]);
      nats.push_back(judge_.judge(all_.points[i], 1, windows).nats);
      (all_.candidates[i].floor ? floor : walls).push_back(nats.back());
      beside += judge_.beside(all_.points[i], windows);
    }
    const double all = sum(walls) + sum(floor), told = told_of(group, sum(nats));
    // Walls go on to any depth: it is the floor that tells it.
    if (!(told > least) || beside > kGroupBeside * all || !most_show(floor)) return;
    walls.insert(walls.end(), floor.begin(), floor.end());
    if (!most_show(walls)) return;
    for (size_t k = 0; k < nats.size(); ++k) {
      const int i = group.members[k];
      if (nats[k] > kAgainst && !is_known(all_.points[i])) add(i, nats[k], int(out_->known.size()));
    }
    out_->known.push_back(sum(group.known) + sum(group.known_floor));
  }

  void add_single(int i) {
    const CurvePoints& points = all_.points[i];
    if (is_known(points)) return;
    const std::vector<Window>& windows = windows_of(all_.candidates[i]);
    const ContrastEvidence e = judge_.judge(points, 1, windows);
    if (!(e.nats > least_) || !all_of_it_shows(e, options_.contrast.accident) ||
        judge_.beside(points, windows) > kBeside * e.nats || is_rim(world_, points, least_))
      return;
    add(i, e.nats, -1);
  }

  const EdgeWorld& world_;
  const MissingOptions& options_;
  CurvePoints strokes_;
  EdgelFlags explained_;
  ContrastJudge judge_;
  JudgedCandidates all_;
  double least_;  // [nat] of one that stands alone
  MissingEdges* out_;
  Sketch added_;
};

// Without the first strokes of the sketch that run along those of groups: of the walls of a pocket
// they are what many views see.
void drop_covered(int first, double px, MissingEdges* all) {
  std::vector<bool> of_group(all->sketch.size(), false), keep(all->sketch.size(), true);
  for (int s = first; s < all->sketch.size(); ++s) of_group[s] = all->group[s - first] >= 0;
  const KnownCurves whole(keep_strokes(all->sketch, of_group), px, kKnownPx * px);
  for (int s = 0; s < first; ++s)
    keep[s] = whole.share(candidate_points(candidate_of(all->sketch, s), px)) <= kWholeShare;
  all->sketch = keep_strokes(all->sketch, keep);
}

}  // namespace

MissingEdges add_missing(const Sketch& sketch, const EdgeWorld& world,
                         const MissingOptions& options) {
  MissingEdges out{sketch, {}, {}, {}, {}, {}, 0};
  std::vector<CurvePoints> refused;
  // What was found leads to expect more: the other rim of a hole that is part of a pattern. In a
  // plane that is known two views tell a circle, but there are so many of these that others would
  // have to be likelier beside them: they come last.
  int ring_views = kRingViews;
  for (int pass = 0; pass < kPasses; ++pass) {
    const int added = Pass(world, options, ring_views, &refused, &out).run();
    if (added == 0 && --ring_views < kFewestRingViews) break;
  }
  drop_covered(sketch.size(), world.footprint, &out);
  return out;
}

}  // namespace sketchsplat
