// SPDX-License-Identifier: MIT
#include "pipelines/candidates/add_missing.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "datasets/types/parallel.h"
#include "edges/contrast/alarm_threshold.h"
#include "edges/views/rim.h"
#include "edges/views/unexplained.h"
#include "pipelines/candidates/depth_copies.h"
#include "pipelines/candidates/level_copies.h"
#include "pipelines/candidates/level_rings.h"
#include "pipelines/candidates/pattern_copies.h"
#include "sketches/curve/sample.h"

namespace sketchsplat {
namespace {

constexpr double kLevelPx = 1.5;      // [px] of a stroke from its level
constexpr double kKnownPx = 2.5;      // [px] from a stroke of what is known already
constexpr double kKnownShare = 0.4;   // of a candidate that makes it so
constexpr double kLeastPx = 8;        // [px] shorter candidates tell too little
constexpr double kShownShare = 0.75;  // of the pieces that must be shown
constexpr int kHaste = 3;             // points of which one is read at first
constexpr int kHastyPoints = 40;      // that are read at most, or nearly
constexpr double kPromise = -1;       // [nat] of a hasty look that asks for a thorough one
constexpr double kNearAsidePx = 6;    // [px] of a copy that shows what is no edge; more by turns
constexpr int kAsides = 7;
constexpr double kMostAsidePx = 30;         // [px] further, of closed ones
constexpr int kNulls = 80, kMostNulls = 8;  // copies that tell a threshold; of one candidate
constexpr int kPasses = 3;
constexpr int kRingViews = 3, kFewestRingViews = 2;  // that agree on a ring, at first and at last
constexpr int kMostCandidates = 8000;  // a sketch that leads to expect more tells nothing
constexpr double kGroup = 2;           // times the nats of one, that all of a group must have
constexpr double kWholeShare = 0.9;    // of one of a group that is known as a whole
constexpr double kKnownNats = 3;       // [nat] of one of a group that is known, as of a clear view
constexpr double kShows = 1;           // [nat] of one of a group that is there
constexpr double kAgainst = -2;        // [nat] of one of a group that is not there after all
constexpr double kBeside = 0.4;        // of the nats of a candidate that copies aside may get
constexpr double kGroupBeside = 0.6;   // of a group: short edges, moved aside, meet neighbours

CurvePoints points_on(const Sketch& sketch, double spacing) {
  const SampleLayout layout = plan_samples(sketch, spacing);
  const Samples samples = evaluate_samples(sketch, layout);
  return {samples.position, samples.tangent, layout.first};
}

EdgelFlags explained_by(const CurvePoints& strokes, const EdgeWorld& world) {
  EdgelFlags explained = no_edgels(world);
  explain(world, strokes, {}, &explained);
  return explained;
}

// What candidates get where there is no edge: copies of each, moved aside in space, all in
// different directions; beside a small closed one by its size, so that it does not cross itself.
CurvePoints moved_aside(const CurvePoints& points, int number, double px) {
  const double golden = M_PI * (3 - std::sqrt(5.0));
  const double z = 1 - 2 * std::fmod((number + 0.5) * 0.618033988749895, 1.0);
  const Eigen::Matrix3Xd& p = points.position;
  const double size = closes(points) ? (p.col(0) - p.col(p.cols() / 2)).norm() : 0;
  const double r = std::sqrt(1 - z * z);
  const double far = std::min(size, kMostAsidePx * px) + px * (kNearAsidePx + number % kAsides);
  CurvePoints out = points;
  out.position.colwise() +=
      far * Eigen::Vector3d(r * std::cos(golden * number), r * std::sin(golden * number), z);
  return out;
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

std::vector<Candidate> all_candidates(const Sketch& sketch, const EdgeWorld& world,
                                      const EdgelFlags& explained, const KnownCurves& known,
                                      const ContrastJudge& judge, int ring_views, int* depths) {
  const double tolerance = kLevelPx * world.footprint;
  const std::vector<Levels> levels = find_levels(sketch, tolerance);
  // Of what several tell the first counts: that which knows from where it is seen.
  std::vector<Candidate> out = depth_copies(sketch, levels, known, judge, world, depths);
  for (Candidate& c : out)
    if (c.group < 0) settle(levels, tolerance, &c);
  for (const std::vector<Candidate>& more :
       {level_copies(sketch, levels), mirror_copies(sketch, levels),
        circle_patterns(sketch, tolerance), level_rings(levels, world, explained, ring_views)})
    for (const Candidate& c : more) {
      out.push_back(c);
      settle(levels, tolerance, &out.back());
    }
  return out;
}

void append(const Candidate& c, Sketch* sketch) {
  const int inner = num_handles(c.kind), first = is_closed(c.kind) ? 0 : 1;
  int begin = -1, end = -1;
  if (!is_closed(c.kind)) {
    begin = sketch->add_node(c.curve.p[0]);
    end = sketch->add_node(c.curve.p[c.curve.count - 1]);
  }
  sketch->add_stroke(c.kind, begin, end,
                     {c.curve.p.begin() + first, c.curve.p.begin() + first + inner});
}

// Candidates that are there or not, all together.
struct Group {
  std::vector<int> members;
  std::vector<double> known, known_floor;  // [nat] of others that the sketch has already
};

// Candidates that are not known, and what they and copies of them that are no edges get.
struct Judged {
  std::vector<Candidate> candidates;
  std::vector<CurvePoints> points;
  std::vector<double> nats, nulls;
  std::map<int, Group> groups;  // of more than one
  int depths = 0;               // that were tried for groups
  int refused = 0;              // that nothing spoke for in a pass before
  int tests() const { return int(candidates.size()) + depths + refused; }
};

// Several sources may tell of one place, from either end.
constexpr double kSamePx = 0.7;
bool is_same(const CurvePoints& a, const CurvePoints& b, double reach) {
  const auto first = a.position.col(0), last = a.position.col(a.position.cols() - 1);
  const auto middle = a.position.col(a.position.cols() / 2);
  const Eigen::Index n = b.position.cols();
  return (middle - b.position.col(n / 2)).norm() < 2 * reach &&
         ((first - b.position.col(0)).norm() < reach || (last - b.position.col(0)).norm() < reach);
}

const std::vector<Window>& windows_of(const Candidate& c) {
  static const std::vector<Window> none;
  return c.windows ? *c.windows : none;
}

using Windows = std::shared_ptr<const std::vector<Window>>;
struct Seen {
  double nats = -INFINITY;
  Windows windows;  // of the likeliest way to see it
};
// A candidate of which nobody knows from where it is seen may be seen from anywhere or, as the
// border of a face in its own plane, from one side of that; all three are as likely. `moved`: its
// points, or a copy of them.
Seen seen_at_best(const Candidate& c, const CurvePoints& moved, const ContrastJudge& judge) {
  const Eigen::Vector3d normal = plane_normal(c.kind, c.curve);
  const bool any_side = !c.windows && c.group < 0 && normal.norm() > 0;
  const Eigen::Vector3d point = moved.position.col(0);
  const Window sides[] = {Window::one_side(normal, point), Window::one_side(-normal, point)};
  const auto seen = [&](int every) {
    const ContrastEvidence e = judge.judge(moved, every, windows_of(c));
    Seen best{e.nats, c.windows};
    double sum = std::exp(e.nats);
    for (int k = 0; k < 2 && any_side; ++k) {
      const double nats = judge.nats_through(e, sides[k], point);
      sum += std::exp(nats);
      if (nats > best.nats) best = {nats, std::make_shared<const std::vector<Window>>(1, sides[k])};
    }
    best.nats = std::log(any_side ? sum / 3 : sum);
    return best;
  };
  const Seen hasty = seen(std::max(kHaste, int(moved.position.cols()) / kHastyPoints));
  return hasty.nats > kPromise ? seen(1) : hasty;
}

// `refused`: candidates of passes before that nothing spoke for; these are added.
Judged judged(const Sketch& sketch, const EdgeWorld& world, const EdgelFlags& explained,
              const ContrastJudge& judge, int ring_views, std::vector<CurvePoints>* refused) {
  const double px = world.footprint;
  const KnownCurves known(sketch, px, kKnownPx * px);
  Judged out;
  const std::vector<Candidate> all =
      all_candidates(sketch, world, explained, known, judge, ring_views, &out.depths);
  if (int(all.size()) > kMostCandidates) return out;
  for (const Candidate& c : all) {
    const CurvePoints points = candidate_points(c, px);
    if (points.position.cols() < kLeastPx) continue;
    const double share = known.share(points);
    if (c.group >= 0 && share > kKnownShare) {
      Group& group = out.groups[c.group];
      (c.floor ? group.known_floor : group.known).push_back(share * kKnownNats);
    }
    if (share > (c.group >= 0 ? kWholeShare : kKnownShare)) continue;
    const auto is_this = [&](const CurvePoints& p) { return is_same(p, points, kSamePx * px); };
    if (std::any_of(out.points.begin(), out.points.end(), is_this)) continue;
    if (c.group < 0 && std::any_of(refused->begin(), refused->end(), is_this)) {
      ++out.refused;
      continue;
    }
    out.candidates.push_back(c);
    out.points.push_back(points);
  }
  const int n = int(out.candidates.size());
  const int copies = std::clamp(kNulls / std::max(1, n), 1, kMostNulls);
  out.nats.resize(n);
  out.nulls.assign(size_t(n) * copies, -INFINITY);
  parallel_for(n, 4, [&](int i) {
    Candidate& c = out.candidates[i];
    for (int k = i * copies; k < (i + 1) * copies; ++k) {
      const CurvePoints aside = moved_aside(out.points[i], k, px);
      if (known.share(aside) <= kKnownShare) out.nulls[k] = seen_at_best(c, aside, judge).nats;
    }
    const Seen seen = seen_at_best(c, out.points[i], judge);
    out.nats[i] = seen.nats;
    c.windows = seen.windows;
  });
  out.nulls.erase(std::remove(out.nulls.begin(), out.nulls.end(), -INFINITY), out.nulls.end());
  for (int i = 0; i < n; ++i) {
    const int group = out.candidates[i].group;
    if (group >= 0)
      out.groups[group].members.push_back(i);
    else if (!(out.nats[i] > 0))
      refused->push_back(out.points[i]);
  }
  return out;
}

// One pass over all candidates.
class Pass {
 public:
  Pass(const Sketch& sketch, const EdgeWorld& world, const MissingOptions& options, int ring_views,
       std::vector<CurvePoints>* refused)
      : sketch_(sketch),
        world_(world),
        options_(options),
        strokes_(points_on(sketch, world.footprint)),
        explained_(explained_by(strokes_, world)),
        judge_(world, strokes_, explained_, options.contrast),
        all_(judged(sketch, world, explained_, judge_, ring_views, refused)),
        least_(alarm_threshold(all_.nulls, all_.candidates.size() + size_t(all_.refused),
                               options.false_strokes / kPasses)),
        least_of_group_(kGroup * std::log((all_.depths + double(all_.groups.size())) * kPasses /
                                          options.false_strokes)) {}

  MissingEdges run() {
    out_ = {sketch_, {}, {}, {}, all_.tests()};
    for (const auto& [number, group] : all_.groups) add_group(group);
    std::vector<int> order(all_.candidates.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return all_.nats[a] > all_.nats[b]; });
    for (const int i : order) {
      if (!(all_.nats[i] > least_)) break;
      add_single(i);
    }
    append_strokes(added_, &out_.sketch);
    return std::move(out_);
  }

 private:
  bool is_known(const CurvePoints& points) const {
    const double px = world_.footprint;
    return KnownCurves(added_, px, kKnownPx * px).share(points) > kKnownShare;
  }

  void add(int i, double nats, bool group) {
    judge_.take(all_.points[i]);
    append(all_.candidates[i], &added_);
    out_.nats.push_back(nats);
    out_.group.push_back(group);
    const Candidate& c = all_.candidates[i];
    if (!group || is_closed(c.kind)) return;
    for (const Eigen::Vector3d& end : {c.curve.p[0], c.curve.p[c.curve.count - 1]}) {
      const Eigen::Matrix3Xd& nodes = sketch_.nodes;
      if ((nodes.colwise() - end).colwise().norm().minCoeff() > world_.footprint)
        out_.corners.push_back(end);
    }
  }

  // They are there or not, all together. Of likelihood ratios of no edges one in exp(x) exceeds x;
  // what one view shows by accident it may show along several of them: they count as two.
  void add_group(const Group& group) {
    if (group.members.empty()) return;
    std::vector<double> hasty;
    for (const int i : group.members) hasty.push_back(all_.nats[i]);
    if (!(sum(hasty) + sum(group.known) + sum(group.known_floor) > least_of_group_)) return;
    double beside = 0;
    std::vector<double> nats, walls = group.known, floor = group.known_floor;
    for (const int i : group.members) {
      const std::vector<Window>& windows = windows_of(all_.candidates[i]);
      nats.push_back(judge_.judge(all_.points[i], 1, windows).nats);
      (all_.candidates[i].floor ? floor : walls).push_back(nats.back());
      beside += judge_.beside(all_.points[i], windows);
    }
    const double all = sum(walls) + sum(floor);
    // Walls go on to any depth: it is the floor that tells it.
    if (!(all > least_of_group_) || beside > kGroupBeside * all || !most_show(floor)) return;
    walls.insert(walls.end(), floor.begin(), floor.end());
    if (!most_show(walls)) return;
    for (size_t k = 0; k < nats.size(); ++k) {
      const int i = group.members[k];
      if (nats[k] > kAgainst && !is_known(all_.points[i])) add(i, nats[k], true);
    }
  }

  void add_single(int i) {
    const CurvePoints& points = all_.points[i];
    if (is_known(points)) return;
    const std::vector<Window>& windows = windows_of(all_.candidates[i]);
    const ContrastEvidence e = judge_.judge(points, 1, windows);
    if (!(e.nats > least_) || !all_of_it_shows(e, options_.contrast.accident) ||
        judge_.beside(points, windows) > kBeside * e.nats || is_rim(world_, points, least_))
      return;
    add(i, e.nats, false);
  }

  const Sketch& sketch_;
  const EdgeWorld& world_;
  const MissingOptions& options_;
  CurvePoints strokes_;
  EdgelFlags explained_;
  ContrastJudge judge_;
  Judged all_;
  double least_, least_of_group_;  // [nat]
  MissingEdges out_;
  Sketch added_;
};

// Without the first strokes of the sketch that run along those of groups: of the walls of a pocket
// they are what many views see.
void drop_covered(int first, double px, MissingEdges* all) {
  std::vector<bool> of_group(all->sketch.size(), false), keep(all->sketch.size(), true);
  for (int s = first; s < all->sketch.size(); ++s) of_group[s] = all->group[s - first];
  const KnownCurves whole(keep_strokes(all->sketch, of_group), px, kKnownPx * px);
  for (int s = 0; s < first; ++s)
    keep[s] =
        whole.share(candidate_points({all->sketch.strokes[s].kind, control_points(all->sketch, s)},
                                     px)) <= kWholeShare;
  all->sketch = keep_strokes(all->sketch, keep);
}

}  // namespace

MissingEdges add_missing(const Sketch& sketch, const EdgeWorld& world,
                         const MissingOptions& options) {
  MissingEdges out{sketch, {}, {}, {}, 0};
  std::vector<CurvePoints> refused;
  // What was found leads to expect more: the other rim of a hole that is part of a pattern. In a
  // plane that is known two views tell a circle, but there are so many of these that others would
  // have to be likelier beside them: they come last.
  int ring_views = kRingViews;
  for (int pass = 0; pass < kPasses; ++pass) {
    const MissingEdges more = Pass(out.sketch, world, options, ring_views, &refused).run();
    out.sketch = more.sketch;
    out.nats.insert(out.nats.end(), more.nats.begin(), more.nats.end());
    out.group.insert(out.group.end(), more.group.begin(), more.group.end());
    out.corners.insert(out.corners.end(), more.corners.begin(), more.corners.end());
    out.candidates += more.candidates;
    if (more.nats.empty() && --ring_views < kFewestRingViews) break;
  }
  drop_covered(sketch.size(), world.footprint, &out);
  return out;
}

}  // namespace sketchsplat
