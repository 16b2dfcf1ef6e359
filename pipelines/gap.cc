// SPDX-License-Identifier: MIT
#include "pipelines/gap.h"

#include <algorithm>

#include "edges/match.h"
#include "sketches/curve.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

constexpr int kFewestSure = 6;  // sightings of a gap that tell something

// Points on a curve between two parameters, two pixels apart, with tangents.
CurvePoints points_between(StrokeKind kind, const ControlPoints& c, double t0, double t1,
                           double length, double footprint) {
  CurvePoints out;
  const int n = std::max(1, int(length / (2 * footprint)));
  out.position.resize(3, n);
  out.tangent.resize(3, n);
  for (int k = 0; k < n; ++k) {
    Vector3d p, d;
    evaluate_curve<double>(kind, c.p.data(), t0 + (t1 - t0) * (k + 0.5) / n, &p, &d);
    out.position.col(k) = p;
    out.tangent.col(k) = d.normalized();
  }
  out.first = {0, n};
  return out;
}

}  // namespace

bool may_hold_edge(StrokeKind kind, const ControlPoints& curve, double t0, double t1, double length,
                   const EdgeWorld& world, const GapOptions& options) {
  const bool narrow = length <= options.narrow_px * world.footprint;
  if (world.hull.empty()) return narrow;
  const CurvePoints gap = points_between(kind, curve, t0, t1, length, world.footprint);
  MatchOptions match;
  match.reach_px = 1.5;
  match.min_run = 0;
  match.exclusive = false;
  const Matches matches = match_samples(world, gap, match);
  int sure = 0, seen = 0;
  for (int i = 0; i < gap.position.cols(); ++i)
    for (size_t v = 0; v < world.views.size(); ++v) {
      if (!world.hull.surely_visible(gap.position.col(i), world.views[v].center_in_world()))
        continue;
      ++sure;
      for (int m = matches.first[i]; m < matches.first[i + 1]; ++m)
        seen += matches.matches[m].view == int(v);
    }
  if (sure < kFewestSure) return narrow || options.trusting;
  return seen >= options.least_seen * sure;
}

}  // namespace sketchsplat
