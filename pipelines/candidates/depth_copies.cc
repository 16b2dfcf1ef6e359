// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "datasets/types/parallel.h"
#include "pipelines/candidates/generators.h"
#include "sketches/curve/curve.h"

namespace sketchsplat {
namespace {

constexpr double kStepPx = 2;       // [px] between depths
constexpr double kNearPx = 4;       // [px] of the first depth
constexpr int kPoints = 60;         // of a loop that are looked at
constexpr double kLeastNats = 1;    // of a depth that is worth a look
constexpr double kCopyShare = 0.6;  // of a loop that is known at another level
constexpr double kInner = 0.8;      // of the size of its level: larger loops bound the part
constexpr int kMostLoops = 10;
constexpr double kClearly = 3;  // [nat] more of what is seen from anywhere: then it is no pocket
constexpr int kSides = 24;      // of a window, per stroke of the loop

using Eigen::Vector3d;

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
    const CurvePoints p = candidate_points(candidate_of(s, i), px);
    const Eigen::Index n = out.position.cols(), m = p.position.cols();
    out.position.conservativeResize(3, n + m), out.tangent.conservativeResize(3, n + m);
    out.position.rightCols(m) = p.position, out.tangent.rightCols(m) = p.tangent;
  }
  out.first = {0, int(out.position.cols())};
  return out;
}

CurvePoints shifted(CurvePoints points, const Vector3d& by) {
  points.position.colwise() += by;
  return points;
}

// Diagonal of the box around.
double size_of(const CurvePoints& points) {
  return (points.position.rowwise().maxCoeff() - points.position.rowwise().minCoeff()).norm();
}

// The nearest other level in which a copy of the loop is known; -1 without.
int copy_of(const CurvePoints& loop, const Levels& l, size_t own, const KnownCurves& known) {
  int out = -1;
  const auto far = [&](int to) { return std::abs(l.height[to] - l.height[own]); };
  for (int to = 0; to < int(l.height.size()); ++to)
    if (to != int(own) && (out < 0 || far(to) < far(out)) &&
        known.share(shifted(loop, (l.height[to] - l.height[own]) * l.normal)) > kCopyShare)
      out = to;
  return out;
}

// What is seen through the loop, and through its copy at a distance `by`, if there is one.
Windows windows_at(const Sketch& s, const std::vector<int>& loop, const Vector3d& normal,
                   const Vector3d& by) {
  std::vector<Eigen::Matrix3Xd> curves, copies;
  for (const int i : loop) {
    Eigen::Matrix3Xd c(3, kSides + 1);
    Vector3d d;
    for (int k = 0; k <= kSides; ++k) {
      Vector3d p;
      evaluate_stroke(s, i, double(k) / kSides, &p, &d);
      c.col(k) = p;
    }
    curves.push_back(c);
    copies.push_back(c.colwise() + by);
  }
  std::vector<Window> out = {Window(normal, curves)};
  if (by.norm() > 0) out.emplace_back(normal, copies);
  return std::make_shared<const std::vector<Window>>(std::move(out));
}

// Nodes in which two strokes of a loop meet in an angle.
std::vector<int> corners_of(const Sketch& s, const std::vector<int>& loop) {
  std::map<int, Vector3d> way;  // into one of them
  std::vector<int> out;
  for (const int i : loop) {
    if (is_closed(s.strokes[i].kind)) continue;
    for (const bool begin : {true, false}) {
      Vector3d p, d;
      evaluate_stroke(s, i, begin ? 0 : 1, &p, &d);
      d = (begin ? d : Vector3d(-d)).normalized();
      const int node = begin ? s.strokes[i].begin : s.strokes[i].end;
      const auto [other, first] = way.emplace(node, d);
      if (!first && other->second.cross(d).norm() > kCornerSine) out.push_back(node);
    }
  }
  return out;
}

// Edges in which the walls of a pocket or hole meet, from the corners of its rim on.
void add_walls(const Sketch& s, const std::vector<int>& loop, const Vector3d& by,
               const Windows& windows, int group, std::vector<Candidate>* out) {
  for (const int node : corners_of(s, loop)) {
    Candidate c;
    c.kind = StrokeKind::kLine;
    c.curve.count = 2;
    c.curve.p[0] = s.nodes.col(node);
    c.curve.p[1] = s.nodes.col(node) + by;
    c.windows = windows;
    c.group = group;
    out->push_back(c);
  }
}

void add_copy(const Sketch& s, const std::vector<int>& loop, const Vector3d& by,
              const Windows& windows, int group, std::vector<Candidate>* out) {
  for (const int i : loop) {
    out->push_back(moved(candidate_of(s, i), by));
    out->back().windows = windows;
    out->back().group = group;
    out->back().floor = group >= 0;
  }
}

struct Depth {
  double depth = 0;  // along the normal, world units; 0: none is worth a look
  double nats = kLeastNats;
};

// The depth at which the judge finds most.
Depth best_depth(const CurvePoints& loop, const Vector3d& normal, double low, double high,
                 const ContrastJudge& judge, const std::vector<Window>& windows, double px,
                 int* depths) {
  const int every = std::max(2, int(loop.position.cols()) / kPoints);
  std::vector<double> depth;
  for (double d = low; d <= high; d += kStepPx * px)
    if (std::abs(d) > kNearPx * px) depth.push_back(d);
  *depths += int(depth.size());
  const auto nats_at = [&](double d) {
    return judge.judge(shifted(loop, d * normal), every, windows).nats;
  };
  std::vector<double> nats(depth.size());
  parallel_for(int(depth.size()), 4, [&](int k) { nats[k] = nats_at(depth[k]); });
  const auto most = std::max_element(nats.begin(), nats.end());
  if (most == nats.end() || *most < kLeastNats) return {};
  const double coarse = depth[most - nats.begin()];
  Depth best{coarse, *most};
  for (const double fine : {-1.5, -1.0, -0.5, 0.5, 1.0, 1.5}) {
    const double here = nats_at(coarse + fine * px);
    if (here > best.nats) best = {coarse + fine * px, here};
  }
  return best;
}

}  // namespace

std::vector<Candidate> depth_copies(const Sketch& sketch, const std::vector<Levels>& levels,
                                    const KnownCurves& known, const ContrastJudge& judge,
                                    const EdgeWorld& world, int* depths) {
  std::vector<Candidate> out;
  int loops = 0, group = 0;
  const double px = world.footprint;
  for (const Levels& l : levels)
    for (size_t own = 0; own < l.height.size() && l.height.size() > 1; ++own) {
      const double whole = size_of(points_of(sketch, l.strokes[own], px));
      for (const std::vector<int>& loop : closed_loops(sketch, l.strokes[own])) {
        const CurvePoints points = points_of(sketch, loop, px);
        if (size_of(points) > kInner * whole) continue;
        const int copy = copy_of(points, l, own, known);
        if (copy >= 0) {
          const Vector3d by = (l.height[copy] - l.height[own]) * l.normal;
          if (copy > int(own))
            add_walls(sketch, loop, by, windows_at(sketch, loop, l.normal, by), group++, &out);
          continue;
        }
        if (++loops > kMostLoops) return out;
        const auto windows = windows_at(sketch, loop, l.normal, Vector3d::Zero());
        const double low = l.height.front() - l.height[own], high = l.height.back() - l.height[own];
        const Depth best = best_depth(points, l.normal, low, high, judge, {}, px, depths);
        const Depth seen = best_depth(points, l.normal, low, high, judge, *windows, px, depths);
        if (seen.depth != 0) {
          const Vector3d by = seen.depth * l.normal;
          add_copy(sketch, loop, by, windows, group, &out);
          add_walls(sketch, loop, by, windows, group++, &out);
        }
        if (best.nats > seen.nats + kClearly)
          add_copy(sketch, loop, best.depth * l.normal, nullptr, -1, &out);
      }
    }
  return out;
}

}  // namespace sketchsplat
