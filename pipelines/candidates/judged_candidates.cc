// SPDX-License-Identifier: MIT
#include "pipelines/candidates/judged_candidates.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "datasets/types/parallel.h"
#include "pipelines/candidates/generators.h"

namespace sketchsplat {
namespace {

constexpr double kLevelPx = 1.5;    // [px] of a stroke from its level
constexpr double kLeastPx = 8;      // [px] shorter candidates tell too little
constexpr int kHaste = 3;           // points of which one is read at first
constexpr int kHastyPoints = 40;    // that are read at most, or nearly
constexpr double kPromise = -1;     // [nat] of a hasty look that asks for a thorough one
constexpr double kNearAsidePx = 6;  // [px] of a copy that shows what is no edge; more by turns
constexpr int kAsides = 7;
constexpr double kMostAsidePx = 30;         // [px] further, of closed ones
constexpr int kNulls = 80, kMostNulls = 8;  // copies that tell a threshold; of one candidate
constexpr int kMostCandidates = 8000;       // a sketch that leads to expect more tells nothing
constexpr size_t kRingsPerStroke = 30;      // of more, most are of speckles
constexpr double kKnownNats = 3;  // [nat] of one of a group that is known, as of a clear view

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

// Rings that views enough agree on to stand alone.
std::vector<Candidate> of_views(const std::vector<LevelRing>& rings, int fewest) {
  std::vector<Candidate> out;
  for (const LevelRing& r : rings)
    if (r.views >= fewest) out.push_back(r.ring);
  return out;
}

std::vector<Candidate> all_candidates(const Sketch& sketch, const EdgeWorld& world,
                                      const EdgelFlags& explained, const KnownCurves& known,
                                      const ContrastJudge& judge, int ring_views,
                                      int* first_pattern, JudgedCandidates* tried) {
  const double tolerance = kLevelPx * world.footprint;
  const std::vector<Levels> levels = find_levels(sketch, tolerance);
  // Of what several tell the first counts: that which knows from where it is seen.
  std::vector<Candidate> out = depth_copies(sketch, levels, known, judge, world, &tried->depths);
  for (Candidate& c : out) {
    if (c.group < 0) settle(levels, tolerance, &c);
    *first_pattern = std::max(*first_pattern, c.group + 1);
  }
  const std::vector<LevelRing> rings =
      level_rings(levels, world, explained, kRingsPerStroke * size_t(sketch.size()));
  for (const std::vector<Candidate>& more :
       {level_copies(sketch, levels), mirror_copies(sketch, levels),
        circle_patterns(sketch, tolerance), of_views(rings, ring_views)})
    for (const Candidate& c : more) {
      out.push_back(c);
      settle(levels, tolerance, &out.back());
    }
  const auto add_patterns = [&](const std::vector<Candidate>& patterns) {
    out.insert(out.end(), patterns.begin(), patterns.end());
    return patterns.empty() ? 0 : patterns.back().group + 1;
  };
  const int next = add_patterns(
      ring_patterns(sketch, rings, tolerance, world, judge, *first_pattern, &tried->patterns));
  add_patterns(symmetry_copies(sketch, levels, known, tolerance, world.footprint,
                               std::max(next, *first_pattern), &tried->patterns));
  return out;
}

// Several sources may tell of one place, from either end.
constexpr double kSamePlacePx = 0.7;
bool is_same(const CurvePoints& a, const CurvePoints& b, double reach) {
  const auto first = a.position.col(0), last = a.position.col(a.position.cols() - 1);
  const auto middle = a.position.col(a.position.cols() / 2);
  const Eigen::Index n = b.position.cols();
  return (middle - b.position.col(n / 2)).norm() < 2 * reach &&
         ((first - b.position.col(0)).norm() < reach || (last - b.position.col(0)).norm() < reach);
}

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

// Candidates that are not known, each once; of those of groups that are known, that they are.
void collect(const std::vector<Candidate>& all, const KnownCurves& known, double px,
             const std::vector<CurvePoints>& refused, int first_pattern, JudgedCandidates* out) {
  for (const Candidate& c : all) {
    const bool pattern = c.group >= first_pattern;
    const CurvePoints points = candidate_points(c, px);
    if (points.position.cols() < kLeastPx) continue;
    const double share = known.share(points);
    if (c.group >= 0 && share > kKnownShare) {
      CandidateGroup& group = out->groups[c.group];
      (c.floor ? group.known_floor : group.known).push_back(share * kKnownNats);
    }
    if (share > (c.group >= 0 && !pattern ? kWholeShare : kKnownShare)) continue;
    const auto is_this = [&](const CurvePoints& p) {
      return is_same(p, points, kSamePlacePx * px);
    };
    if (c.group < 0 && std::any_of(out->points.begin(), out->points.end(), is_this)) continue;
    if (c.group < 0 && std::any_of(refused.begin(), refused.end(), is_this)) {
      ++out->refused;
      continue;
    }
    out->candidates.push_back(c);
    out->points.push_back(points);
    if (!pattern) out->singles = int(out->candidates.size());
  }
}

// What they get, at a first look, and copies of them.
void judge_all(const KnownCurves& known, const ContrastJudge& judge, double px,
               JudgedCandidates* out) {
  const int n = int(out->candidates.size());
  const int copies = std::clamp(kNulls / std::max(1, out->singles), 1, kMostNulls);
  out->nats.resize(n);
  out->nulls.assign(size_t(out->singles) * copies, -INFINITY);
  parallel_for(n, 4, [&](int i) {
    Candidate& c = out->candidates[i];
    for (int k = i * copies; k < (i + 1) * copies && i < out->singles; ++k) {
      const CurvePoints aside = moved_aside(out->points[i], k, px);
      if (known.share(aside) <= kKnownShare) out->nulls[k] = seen_at_best(c, aside, judge).nats;
    }
    const Seen seen = seen_at_best(c, out->points[i], judge);
    out->nats[i] = seen.nats;
    c.windows = seen.windows;
  });
  out->nulls.erase(std::remove(out->nulls.begin(), out->nulls.end(), -INFINITY), out->nulls.end());
}

}  // namespace

JudgedCandidates judge_candidates(const Sketch& sketch, const EdgeWorld& world,
                                  const EdgelFlags& explained, const ContrastJudge& judge,
                                  int ring_views, std::vector<CurvePoints>* refused) {
  const double px = world.footprint;
  const KnownCurves known(sketch, px, kKnownPx * px);
  JudgedCandidates out;
  int first_pattern = 0;
  const std::vector<Candidate> all =
      all_candidates(sketch, world, explained, known, judge, ring_views, &first_pattern, &out);
  if (int(all.size()) > kMostCandidates) return out;
  collect(all, known, px, *refused, first_pattern, &out);
  judge_all(known, judge, px, &out);
  for (int i = 0; i < int(out.candidates.size()); ++i) {
    const int group = out.candidates[i].group;
    if (group >= 0)
      out.groups[group].members.push_back(i);
    else if (!(out.nats[i] > 0))
      refused->push_back(out.points[i]);
  }
  for (auto& [number, group] : out.groups) group.pattern = number >= first_pattern;
  return out;
}

}  // namespace sketchsplat
