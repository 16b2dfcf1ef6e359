// SPDX-License-Identifier: MIT
#include "pipelines/method/blends.h"

#include <algorithm>
#include <numeric>

#include "pipelines/method/lift_and_fit.h"
#include "pipelines/options/derived_options.h"
#include "pipelines/survey/explained.h"
#include "pipelines/survey/round_judge.h"
#include "pipelines/survey/select.h"

namespace sketchsplat {
namespace {

constexpr double kMoves = 0.3;      // of its radius, by the outline of a blend of a right angle
constexpr double kMostPx = 40;      // [px] radius of a rounded edge: wider ones are surfaces
constexpr double kBesidePx = 8;     // [px] of strokes on one round whose radius nobody knows
constexpr double kSameShare = 0.5;  // of a stroke that lies on a blend that is known

double share_within(const Eigen::Matrix3Xd& points, const Eigen::Matrix3Xd& of, double distance) {
  int near = 0;
  for (int i = 0; i < points.cols(); ++i)
    near += (of.colwise() - points.col(i)).colwise().squaredNorm().minCoeff() < distance * distance;
  return double(near) / std::max<double>(1, double(points.cols()));
}

// Strokes that the judge takes for rounds, of all that the sketch does not explain.
Sketch round_strokes(const Sketch& sketch, const EdgeWorld& world,
                     const ReconstructOptions& options) {
  Sketch both = sketch;
  append_strokes(strokes_of_rest(sketch, world, options), &both);
  const Selection chosen = select_strokes(both, world, select_options(options));
  std::vector<bool> keep(both.size());
  for (int i = sketch.size(); i < both.size(); ++i) keep[i] = chosen.verdicts[i] == Verdict::kRound;
  return keep_strokes(both, keep);
}

// Of strokes on one round, the first; wider ones than asked for are none.
std::vector<bool> one_each(const std::vector<RoundJudge::Radius>& radii, const Observation& wide,
                           double footprint) {
  std::vector<int> order(radii.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return radii[a].views > radii[b].views; });
  std::vector<bool> keep(radii.size());
  std::vector<CurvePoints> known;
  std::vector<double> reach;
  for (const int i : order) {
    if (radii[i].px > kMostPx) continue;
    const CurvePoints points = points_of(wide, i);
    bool same = false;
    for (size_t k = 0; k < known.size() && !same; ++k)
      same = share_within(points.position, known[k].position, reach[k]) > kSameShare;
    if (same) continue;
    known.push_back(points);
    reach.push_back(std::max(radii[i].px, kBesidePx) * footprint);
    keep[i] = true;
  }
  return keep;
}

}  // namespace

Blends find_blends(const Sketch& sketch, const EdgeWorld& world,
                   const ReconstructOptions& options) {
  const Sketch rounds = round_strokes(sketch, world, options);
  Blends out;
  if (rounds.size() == 0) return out;
  const EdgelFlags others = edgels_along(sketch, world);
  // The widths of edges are those of the sketch.
  Sketch all = rounds;
  append_strokes(sketch, &all);
  const Observation wide = observe_rounds(all, world, kMoves * kMostPx);
  const RoundJudge judge(world, wide, select_options(options).round);
  std::vector<RoundJudge::Radius> radii;
  for (int i = 0; i < rounds.size(); ++i) radii.push_back(judge.radius(i, &others));
  const std::vector<bool> keep = one_each(radii, wide, world.footprint);
  for (int i = 0; i < rounds.size(); ++i)
    if (keep[i])
      out.blends.push_back(
          {radii[i].px * world.footprint, radii[i].sigma_px * world.footprint, radii[i].views});
  out.curves = keep_strokes(rounds, keep);
  return out;
}

}  // namespace sketchsplat
