// SPDX-License-Identifier: MIT
#include "eval/metrics/junctions.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace sketchsplat {
namespace {

constexpr double kNear = 5e-3;  // of a predicted junction to its true one

struct Corner {
  Eigen::Vector3d position;
  bool visible;
};

std::vector<Corner> junctions_of(const std::vector<TrueEdge>& edges) {
  std::vector<Eigen::Matrix3Xd> curves;
  for (const TrueEdge& edge : edges) curves.push_back(edge.polyline);
  std::vector<Corner> corners;
  for (const MeetingPoint& point : meeting_points(curves)) {
    const auto other = [&](int curve) { return curve != point.curves.front(); };
    if (std::none_of(point.curves.begin(), point.curves.end(), other)) continue;
    bool visible = false;
    for (int k : point.curves) {
      const TrueEdge& edge = edges[size_t(k)];
      if (edge.visible.empty()) continue;
      const Eigen::Matrix3Xd& p = edge.polyline;
      const bool first = (p.col(0) - point.position).squaredNorm() <
                         (p.rightCols<1>() - point.position).squaredNorm();
      visible = visible || (first ? edge.visible.front() : edge.visible.back());
    }
    corners.push_back({point.position, visible});
  }
  return corners;
}

double percent(int part, int whole) { return whole > 0 ? 100.0 * part / whole : 0; }

// Without any junction on either side there is nothing to be right or wrong about.
void fill_shares(Junctions* j) {
  if (j->predicted + j->truth == 0) return;
  j->precision = percent(j->matched, j->predicted);
  if (j->truth > 0) j->recall = percent(j->matched, j->truth);
  j->f = percent(2 * j->matched, j->predicted + j->truth);
}

}  // namespace

std::vector<MeetingPoint> meeting_points(const std::vector<Eigen::Matrix3Xd>& curves) {
  const int count = 2 * int(curves.size());
  Eigen::Matrix3Xd ends(3, count);
  for (size_t k = 0; k < curves.size(); ++k) {
    ends.col(Eigen::Index(2 * k)) = curves[k].col(0);
    ends.col(Eigen::Index(2 * k + 1)) = curves[k].rightCols<1>();
  }
  // Each end points to an earlier one of its group, the first of all to itself.
  std::vector<int> first(count);
  std::iota(first.begin(), first.end(), 0);
  const auto root = [&](int i) {
    while (first[i] != i) i = first[i] = first[first[i]];
    return i;
  };
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < i; ++j) {
      if ((ends.col(i) - ends.col(j)).squaredNorm() >= kMeeting * kMeeting) continue;
      const int a = root(i), b = root(j);
      first[std::max(a, b)] = std::min(a, b);
    }
  }
  std::vector<MeetingPoint> points;
  std::vector<int> point_of(count, -1);
  for (int i = 0; i < count; ++i) {
    const int r = root(i);
    if (r == i) {
      point_of[i] = int(points.size());
      points.emplace_back();
    }
    MeetingPoint& point = points[point_of[r]];
    point.position += ends.col(i);
    point.curves.push_back(i / 2);
  }
  for (MeetingPoint& point : points) point.position /= double(point.curves.size());
  return points;
}

Junctions match_junctions(const std::vector<TrueEdge>& prediction,
                          const std::vector<TrueEdge>& truth) {
  const std::vector<Corner> ours = junctions_of(prediction), theirs = junctions_of(truth);
  std::vector<std::tuple<double, int, int>> pairs;
  for (int i = 0; i < int(ours.size()); ++i) {
    for (int j = 0; j < int(theirs.size()); ++j) {
      const double distance = (ours[i].position - theirs[j].position).norm();
      if (distance < kNear) pairs.emplace_back(distance, i, j);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  Junctions result;
  result.predicted = int(ours.size());
  result.truth = int(theirs.size());
  std::vector<bool> used(ours.size()), found(theirs.size());
  int visible_found = 0;
  for (const auto& [distance, i, j] : pairs) {
    if (used[i] || found[j]) continue;
    used[i] = found[j] = true;
    ++result.matched;
    if (theirs[j].visible) ++visible_found;
  }
  for (const Corner& corner : theirs) result.truth_visible += corner.visible;
  fill_shares(&result);
  if (result.truth_visible > 0) {
    result.recall_visible = percent(visible_found, result.truth_visible);
  }
  return result;
}

}  // namespace sketchsplat
