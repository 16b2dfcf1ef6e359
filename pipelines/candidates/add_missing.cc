// SPDX-License-Identifier: MIT
#include "pipelines/candidates/add_missing.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "edges/contrast/alarm_threshold.h"
#include "edges/views/rim.h"
#include "edges/views/unexplained.h"
#include "pipelines/candidates/depth_copies.h"
#include "pipelines/candidates/level_copies.h"
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
constexpr int kPasses = 3;
constexpr int kMostCandidates = 8000;  // a sketch that leads to expect more tells nothing
constexpr double kBeside = 0.4;  // of the nats of a candidate that copies aside may get

ContrastJudge judge_beside(const Sketch& sketch, const EdgeWorld& world,
                           const ContrastOptions& options) {
  const SampleLayout layout = plan_samples(sketch, world.footprint);
  const Samples samples = evaluate_samples(sketch, layout);
  const CurvePoints strokes{samples.position, samples.tangent, layout.first};
  EdgelFlags explained = no_edgels(world);
  explain(world, strokes, {}, &explained);
  return {world, strokes, explained, options};
}

// What candidates get where there is no edge: a copy of each, moved aside in space, all in
// different directions.
CurvePoints moved_aside(const CurvePoints& points, int number, double px) {
  const double golden = M_PI * (3 - std::sqrt(5.0));
  const double z = 1 - 2 * std::fmod((number + 0.5) * 0.618033988749895, 1.0);
  const double r = std::sqrt(1 - z * z), far = px * (kNearAsidePx + number % kAsides);
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

// The contour of a round surface is no edge, though many views show it near one place.
bool is_rim(const EdgeWorld& world, const CurvePoints& points, double least) {
  const Rim rim = fit_rim(world, points, {});
  return rim.nats > least || rim.is_round(world.footprint);
}

std::vector<Candidate> all_candidates(const Sketch& sketch, const EdgeWorld& world,
                                      const KnownCurves& known, const ContrastJudge& judge,
                                      int* depths) {
  const std::vector<Levels> levels = find_levels(sketch, kLevelPx * world.footprint);
  std::vector<Candidate> out = level_copies(sketch, levels);
  for (const std::vector<Candidate>& more :
       {mirror_copies(sketch, levels), circle_patterns(sketch, kLevelPx * world.footprint),
        depth_copies(sketch, levels, known, judge, world, depths)})
    out.insert(out.end(), more.begin(), more.end());
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

// Candidates that are not known, and what they and copies of them that are no edges get.
struct Judged {
  std::vector<Candidate> candidates;
  std::vector<CurvePoints> points;
  std::vector<double> nats, nulls;
  int tests = 0;
};

// Several sources may tell of one place, from either end.
bool is_same(const CurvePoints& a, const CurvePoints& b, double reach) {
  const auto first = a.position.col(0), last = a.position.col(a.position.cols() - 1);
  const auto middle = a.position.col(a.position.cols() / 2);
  const Eigen::Index n = b.position.cols();
  return (middle - b.position.col(n / 2)).norm() < 2 * reach &&
         ((first - b.position.col(0)).norm() < reach || (last - b.position.col(0)).norm() < reach);
}

Judged judged(const Sketch& sketch, const EdgeWorld& world, const ContrastJudge& judge) {
  const double px = world.footprint;
  const KnownCurves known(sketch, px, kKnownPx * px);
  Judged out;
  const std::vector<Candidate> all = all_candidates(sketch, world, known, judge, &out.tests);
  if (int(all.size()) > kMostCandidates) return out;
  for (const Candidate& c : all) {
    const CurvePoints points = candidate_points(c, px);
    if (points.position.cols() < kLeastPx || known.share(points) > kKnownShare) continue;
    if (std::any_of(out.points.begin(), out.points.end(),
                    [&](const CurvePoints& p) { return is_same(p, points, 0.7 * px); }))
      continue;
    out.candidates.push_back(c);
    out.points.push_back(points);
  }
  const int n = int(out.candidates.size());
  out.tests += n;
  out.nats.resize(n);
  out.nulls.assign(n, -INFINITY);
  const auto nats = [&](const CurvePoints& points) {
    const int every = std::max(kHaste, int(points.position.cols()) / kHastyPoints);
    const double hasty = judge.judge(points, every).nats;
    return hasty > kPromise ? judge.judge(points).nats : hasty;
  };
#pragma omp parallel for schedule(dynamic, 4)
  for (int i = 0; i < n; ++i) {
    out.nats[i] = nats(out.points[i]);
    const CurvePoints aside = moved_aside(out.points[i], i, px);
    if (known.share(aside) <= kKnownShare) out.nulls[i] = nats(aside);
  }
  out.nulls.erase(std::remove(out.nulls.begin(), out.nulls.end(), -INFINITY), out.nulls.end());
  return out;
}

MissingEdges one_pass(const Sketch& sketch, const EdgeWorld& world, const MissingOptions& options) {
  const double px = world.footprint;
  ContrastJudge judge = judge_beside(sketch, world, options.contrast);
  const Judged all = judged(sketch, world, judge);
  const double least = alarm_threshold(all.nulls, all.tests, options.false_strokes / kPasses);
  std::vector<int> order(all.candidates.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return all.nats[a] > all.nats[b]; });
  MissingEdges out{sketch, {}, all.tests};
  Sketch added;
  for (const int i : order) {
    if (!(all.nats[i] > least)) break;
    const CurvePoints& points = all.points[i];
    if (KnownCurves(added, px, kKnownPx * px).share(points) > kKnownShare) continue;
    const ContrastEvidence e = judge.judge(points);
    if (!(e.nats > least) || !all_of_it_shows(e, options.contrast.accident) ||
        judge.beside(points) > kBeside * e.nats || is_rim(world, points, least))
      continue;
    judge.take(points);
    append(all.candidates[i], &added);
    out.nats.push_back(e.nats);
  }
  append_strokes(added, &out.sketch);
  return out;
}

}  // namespace

MissingEdges add_missing(const Sketch& sketch, const EdgeWorld& world,
                         const MissingOptions& options) {
  MissingEdges out{sketch, {}, 0};
  // What was found leads to expect more: the other rim of a hole that is part of a pattern.
  for (int pass = 0; pass < kPasses; ++pass) {
    const MissingEdges more = one_pass(out.sketch, world, options);
    out.sketch = more.sketch;
    out.nats.insert(out.nats.end(), more.nats.begin(), more.nats.end());
    out.candidates += more.candidates;
    if (more.nats.empty()) break;
  }
  return out;
}

}  // namespace sketchsplat
