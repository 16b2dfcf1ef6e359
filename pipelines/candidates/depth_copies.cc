// SPDX-License-Identifier: MIT
#include "pipelines/candidates/depth_copies.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace sketchsplat {
namespace {

constexpr double kStepPx = 2;       // [px] between depths
constexpr double kNearPx = 4;       // [px] of the first depth
constexpr int kPoints = 60;         // of a loop that are looked at
constexpr double kLeastNats = 1;    // of a depth that is worth a look
constexpr double kCopyShare = 0.6;  // of a loop that is known at another level
constexpr double kInner = 0.8;      // of the size of its level: larger loops bound the part
constexpr int kMostLoops = 10;

// Closed strokes, and strokes of a level that hang together with no loose end.
std::vector<std::vector<int>> closed_loops(const Sketch& s, const std::vector<int>& strokes) {
  std::vector<std::vector<int>> out;
  std::map<int, std::vector<int>> at;  // strokes by node
  for (const int i : strokes) {
    if (is_closed(s.strokes[i].kind))
      out.push_back({i});
    else
      at[s.strokes[i].begin].push_back(i), at[s.strokes[i].end].push_back(i);
  }
  std::map<int, bool> done;
  for (const int start : strokes) {
    if (is_closed(s.strokes[start].kind) || done[start]) continue;
    std::vector<int> group = {start};
    done[start] = true;
    bool closed = true;
    for (size_t k = 0; k < group.size(); ++k)
      for (const int node : {s.strokes[group[k]].begin, s.strokes[group[k]].end}) {
        closed = closed && at[node].size() == 2;
        for (const int next : at[node])
          if (!done[next]) done[next] = true, group.push_back(next);
      }
    if (closed && group.size() > 1) out.push_back(group);
  }
  return out;
}

CurvePoints points_of(const Sketch& s, const std::vector<int>& loop, double px) {
  CurvePoints out;
  for (const int i : loop) {
    const CurvePoints p = candidate_points({s.strokes[i].kind, control_points(s, i)}, px);
    const Eigen::Index n = out.position.cols(), m = p.position.cols();
    out.position.conservativeResize(3, n + m), out.tangent.conservativeResize(3, n + m);
    out.position.rightCols(m) = p.position, out.tangent.rightCols(m) = p.tangent;
  }
  out.first = {0, int(out.position.cols())};
  return out;
}

CurvePoints shifted(CurvePoints points, const Eigen::Vector3d& by) {
  points.position.colwise() += by;
  return points;
}

// Diagonal of the box around.
double size_of(const CurvePoints& points) {
  return (points.position.rowwise().maxCoeff() - points.position.rowwise().minCoeff()).norm();
}

bool has_copy(const CurvePoints& loop, const Levels& l, size_t own, const KnownCurves& known) {
  for (size_t to = 0; to < l.height.size(); ++to)
    if (to != own &&
        known.share(shifted(loop, (l.height[to] - l.height[own]) * l.normal)) > kCopyShare)
      return true;
  return false;
}

// The depth at which the judge finds most; 0 if none is worth a look.
double best_depth(const CurvePoints& loop, const Eigen::Vector3d& normal, double low, double high,
                  const ContrastJudge& judge, double px, int* depths) {
  const int every = std::max(2, int(loop.position.cols()) / kPoints);
  std::vector<double> depth;
  for (double d = low; d <= high; d += kStepPx * px)
    if (std::abs(d) > kNearPx * px) depth.push_back(d);
  *depths += int(depth.size());
  std::vector<double> nats(depth.size());
#pragma omp parallel for schedule(dynamic, 4)
  for (int k = 0; k < int(depth.size()); ++k)
    nats[k] = judge.judge(shifted(loop, depth[k] * normal), every).nats;
  const auto most = std::max_element(nats.begin(), nats.end());
  if (most == nats.end() || *most < kLeastNats) return 0;
  double best = depth[most - nats.begin()], value = *most;
  for (const double fine : {-1.5, -1.0, -0.5, 0.5, 1.0, 1.5}) {
    const double d = depth[most - nats.begin()] + fine * px;
    const double here = judge.judge(shifted(loop, d * normal), every).nats;
    if (here > value) best = d, value = here;
  }
  return best;
}

}  // namespace

std::vector<Candidate> depth_copies(const Sketch& sketch, const std::vector<Levels>& levels,
                                    const KnownCurves& known, const ContrastJudge& judge,
                                    const EdgeWorld& world, int* depths) {
  std::vector<Candidate> out;
  int loops = 0;
  for (const Levels& l : levels)
    for (size_t own = 0; own < l.height.size() && l.height.size() > 1; ++own) {
      const double whole = size_of(points_of(sketch, l.strokes[own], world.footprint));
      for (const std::vector<int>& loop : closed_loops(sketch, l.strokes[own])) {
        const CurvePoints points = points_of(sketch, loop, world.footprint);
        if (size_of(points) > kInner * whole) continue;
        if (has_copy(points, l, own, known)) continue;
        if (++loops > kMostLoops) return out;
        const double d =
            best_depth(points, l.normal, l.height.front() - l.height[own],
                       l.height.back() - l.height[own], judge, world.footprint, depths);
        if (d == 0) continue;
        for (const int i : loop)
          out.push_back(moved({sketch.strokes[i].kind, control_points(sketch, i)}, d * l.normal));
      }
    }
  return out;
}

}  // namespace sketchsplat
