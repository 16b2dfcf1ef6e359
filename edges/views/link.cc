// SPDX-License-Identifier: MIT
#include "edges/views/link.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "datasets/neighbours/kd_tree.h"

namespace sketchsplat {
namespace {

constexpr double kMergePx = 2;   // points of one curve nearer than this along it become one
constexpr double kAsidePx = 1;   // largest offset across the tangent of points of one curve
constexpr double kReachPx = 14;  // longest step from point to point
constexpr double kBendDeg = 20;  // largest disagreement with the circle through both points

KdTree tree_of(const std::vector<EdgePoint>& points) {
  Eigen::Matrix3Xd positions(3, points.size());
  for (size_t i = 0; i < points.size(); ++i) positions.col(i) = points[i].position;
  return KdTree(positions);
}

// The neighbour that continues point i along side * tangent, or -1.
int successor(const std::vector<EdgePoint>& points, const KdTree& neighbours, int i, int side,
              double footprint) {
  const EdgePoint& p = points[i];
  const Eigen::Vector3d t = p.tangent * side;
  const double max_sine = std::sin(kBendDeg * M_PI / 180);
  const double reach = kReachPx * footprint;
  int best = -1;
  double best_cost = 1e300;
  for (int j : neighbours.within(p.position, reach)) {
    if (j == i) continue;
    const Eigen::Vector3d v = points[j].position - p.position;
    const double distance = v.norm();
    if (!(distance > 0)) continue;
    const Eigen::Vector3d u = v / distance;
    const double ahead = u.dot(t);
    if (ahead < 0.8) continue;
    // A circle that leaves p along t and passes j arrives there along 2 (t.u) u - t.
    const Eigen::Vector3d arrival = 2 * ahead * u - t;
    const double sine = arrival.cross(points[j].tangent).norm();
    // Beside each other by noise alone, close points say nothing about the direction between them.
    const double slack = 0.5 * footprint / distance;
    if (sine > max_sine + slack) continue;
    const double cost = distance * (1 + 4 * (1 - ahead) + 2 * sine);
    if (cost < best_cost) best_cost = cost, best = j;
  }
  return best;
}

}  // namespace

std::vector<EdgePoint> thin_points(const std::vector<EdgePoint>& points, double footprint) {
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    if (points[a].views != points[b].views) return points[a].views > points[b].views;
    return points[a].rms_px < points[b].rms_px;
  });
  const KdTree neighbours = tree_of(points);
  std::vector<bool> gone(points.size());
  std::vector<EdgePoint> out;
  for (int i : order) {
    if (gone[i]) continue;
    const EdgePoint& p = points[i];
    out.push_back(p);
    for (int j : neighbours.within(p.position, kMergePx * footprint)) {
      const Eigen::Vector3d v = points[j].position - p.position;
      const double aside = (v - p.tangent * p.tangent.dot(v)).norm();
      if (aside < kAsidePx * footprint && std::abs(p.tangent.dot(points[j].tangent)) > 0.9)
        gone[j] = true;
    }
  }
  return out;
}

std::vector<PointChain> link_points(const std::vector<EdgePoint>& points, double footprint) {
  const int n = int(points.size());
  const KdTree neighbours = tree_of(points);
  std::vector<int> link[2];  // along +tangent, along -tangent
  for (int side = 0; side < 2; ++side) {
    link[side].resize(n);
    for (int i = 0; i < n; ++i)
      link[side][i] = successor(points, neighbours, i, side == 0 ? 1 : -1, footprint);
  }
  // Which side of j looks back at i; -1 if the choice is not mutual.
  const auto side_back = [&](int j, int i) {
    return j < 0 ? -1 : link[0][j] == i ? 0 : link[1][j] == i ? 1 : -1;
  };
  std::vector<bool> done(n);
  std::vector<PointChain> chains;
  const auto walk = [&](int i, int side, std::vector<int>* run) {  // true if it came back to i
    const int start = i;
    for (;;) {
      const int j = link[side][i], back = side_back(j, i);
      if (back < 0) return false;
      if (j == start) return true;
      if (done[j]) return false;
      done[j] = true;
      run->push_back(j);
      i = j, side = 1 - back;
    }
  };
  for (int i = 0; i < n; ++i) {
    if (done[i]) continue;
    done[i] = true;
    std::vector<int> forward, backward;
    PointChain chain;
    chain.closed = walk(i, 0, &forward);
    if (!chain.closed) walk(i, 1, &backward);
    chain.points.assign(backward.rbegin(), backward.rend());
    chain.points.push_back(i);
    chain.points.insert(chain.points.end(), forward.begin(), forward.end());
    if (chain.points.size() >= 2) chains.push_back(chain);
  }
  return chains;
}

}  // namespace sketchsplat
