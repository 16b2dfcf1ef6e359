// SPDX-License-Identifier: MIT
#include "pipelines/survey/gap.h"

#include <algorithm>
#include <cmath>

#include "edges/views/match.h"
#include "sketches/curve/curve.h"
#include "sketches/fit/segment.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

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

double gap_cost(StrokeKind kind, const ControlPoints& curve, double t0, double t1, double length,
                const EdgeWorld& world, const GapOptions& options) {
  const CurvePoints gap = points_between(kind, curve, t0, t1, length, world.footprint);
  MatchOptions match;
  match.reach_px = 1.5;
  match.min_run = 0;
  match.exclusive = false;
  match.quadratics = false;
  const Matches matches = match_samples(world, gap, match);
  const bool blind = world.hull.empty();
  const double rate = blind ? options.found_rate : options.seen_rate;
  const double if_seen = std::log(options.chance_rate / rate);
  const double if_not = std::log((1 - options.chance_rate) / (1 - rate));
  double cost = 0;
  for (int i = 0; i < gap.position.cols(); ++i) {
    std::vector<char> seen(world.views.size());
    for (int m = matches.first[i]; m < matches.first[i + 1]; ++m) seen[matches.matches[m].view] = 1;
    double here = 0;
    for (size_t v = 0; v < world.views.size(); ++v)
      if (blind || world.hull.surely_visible(gap.position.col(i), world.views[v].center_in_world()))
        here += seen[v] ? if_seen : if_not;
    cost += std::clamp(here, -kOutlierNats, kOutlierNats);
  }
  return cost;
}

}  // namespace sketchsplat
