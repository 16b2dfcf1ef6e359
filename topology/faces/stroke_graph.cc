// SPDX-License-Identifier: MIT
#include "topology/faces/stroke_graph.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace sketchsplat {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Vector2d;

double signed_area(const Matrix2Xd& polygon) {
  double twice = 0;
  const Vector2d o = polygon.col(0);
  for (int i = 0; i < polygon.cols(); ++i) {
    const Vector2d a = polygon.col(i) - o, b = polygon.col((i + 1) % polygon.cols()) - o;
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

// A graph whose edges are walked in both directions: half-edge 2 m is the member m forward,
// 2 m + 1 backward.
class Graph {
 public:
  Graph(const Sketch& sketch, const std::vector<int>& members, const std::vector<Matrix2Xd>& lines,
        const Vector2d& period)
      : sketch_(sketch),
        members_(members),
        alive_(members.size(), true),
        lines_(lines),
        period_(period) {}

  // Simple cycles of the graph without its bridges.
  std::vector<Cycle> cycles() {
    std::vector<std::vector<int>> walks;
    do {
      drop_dangling();
      walks = walk();
    } while (drop_bridges(walks));
    const std::vector<int> part = parts();
    std::vector<Cycle> out;
    for (size_t w = 0; w < walks.size(); ++w)
      for (const std::vector<int>& simple : cut_at_repeated_nodes(walks[w])) {
        Cycle c;
        for (const int h : simple) c.loop.push_back({members_[h / 2], h % 2 == 0});
        c.polygon = polygon_of(simple, &c.turns, &c.turns_across);
        c.area = c.turns == 0 && c.turns_across == 0 ? signed_area(c.polygon) : 0;
        c.part = part[simple[0] / 2];
        c.walk = int(w);
        out.push_back(c);
      }
    return out;
  }

 private:
  bool closed(int m) const { return is_closed(sketch_.strokes[members_[m]].kind); }
  // Node from which a half-edge starts.
  int tail(int h) const {
    const Stroke& s = sketch_.strokes[members_[h / 2]];
    return h % 2 == 0 ? s.begin : s.end;
  }

  void drop_dangling() {
    for (bool changed = true; changed;) {
      changed = false;
      std::map<int, int> degree;
      for (int h = 0; h < int(2 * alive_.size()); ++h)
        if (alive_[h / 2] && !closed(h / 2)) ++degree[tail(h)];
      for (int m = 0; m < int(alive_.size()); ++m)
        if (alive_[m] && !closed(m) && (degree[tail(2 * m)] < 2 || degree[tail(2 * m + 1)] < 2)) {
          alive_[m] = false;
          changed = true;
        }
    }
  }

  // A stroke whose two sides belong to one walk separates nothing.
  bool drop_bridges(const std::vector<std::vector<int>>& walks) {
    std::vector<int> of(2 * alive_.size(), -1);
    for (size_t w = 0; w < walks.size(); ++w)
      for (const int h : walks[w]) of[h] = int(w);
    bool any = false;
    for (size_t m = 0; m < alive_.size(); ++m)
      if (alive_[m] && of[2 * m] == of[2 * m + 1]) {
        alive_[m] = false;
        any = true;
      }
    return any;
  }

  double length(int m) const {
    const Matrix2Xd& l = lines_[m];
    return (l.rightCols(l.cols() - 1) - l.leftCols(l.cols() - 1)).colwise().norm().sum();
  }

  // Direction to the point at this length along a half-edge: where the tangents of two strokes
  // agree, their curvature still tells which is on the left.
  double direction(int h, double reach) const {
    const Matrix2Xd& l = lines_[h / 2];
    const int n = int(l.cols());
    const auto at = [&](int i) -> Vector2d { return l.col(h % 2 == 0 ? i : n - 1 - i); };
    Vector2d p = at(n - 1);
    for (int i = 1; i < n; ++i) {
      const double step = (at(i) - at(i - 1)).norm();
      if (reach <= step) {
        p = at(i - 1) + reach / std::max(step, 1e-300) * (at(i) - at(i - 1));
        break;
      }
      reach -= step;
    }
    return std::atan2(p.y() - at(0).y(), p.x() - at(0).x());
  }

  // All walks that keep their inside on the left: at every node on to the next stroke clockwise.
  std::vector<std::vector<int>> walk() const {
    std::map<int, std::vector<int>> out_of;
    for (int h = 0; h < int(2 * alive_.size()); ++h)
      if (alive_[h / 2] && !closed(h / 2)) out_of[tail(h)].push_back(h);
    std::vector<int> next(2 * alive_.size(), -1);
    for (auto& [node, half_edges] : out_of) {
      double reach = HUGE_VAL;
      for (const int h : half_edges) reach = std::min(reach, 0.1 * length(h / 2));
      std::vector<std::pair<double, int>> sorted;
      for (const int h : half_edges) sorted.emplace_back(direction(h, reach), h);
      std::sort(sorted.begin(), sorted.end());
      for (size_t i = 0; i < sorted.size(); ++i)
        next[sorted[i].second ^ 1] = sorted[(i + sorted.size() - 1) % sorted.size()].second;
    }
    std::vector<std::vector<int>> walks;
    std::vector<bool> done(2 * alive_.size());
    for (int first = 0; first < int(done.size()); ++first) {
      if (!alive_[first / 2] || done[first]) continue;
      std::vector<int> way;
      if (closed(first / 2)) {
        way = {first};
        done[first] = true;
      }
      for (int h = first; !done[h]; h = next[h]) {
        done[h] = true;
        way.push_back(h);
      }
      walks.push_back(way);
    }
    return walks;
  }

  std::vector<std::vector<int>> cut_at_repeated_nodes(const std::vector<int>& walk) const {
    if (closed(walk[0] / 2)) return {walk};
    std::vector<std::vector<int>> out;
    std::vector<int> open;
    for (const int h : walk) {
      open.push_back(h);
      const int head = tail(h ^ 1);
      const auto from =
          std::find_if(open.begin(), open.end(), [&](int other) { return tail(other) == head; });
      if (from == open.end()) continue;
      out.emplace_back(from, open.end());
      open.erase(from, open.end());
    }
    return out;
  }

  // Without its last point, which is the first one after so many turns.
  Matrix2Xd polygon_of(const std::vector<int>& half_edges, int* turns, int* across) const {
    std::vector<Vector2d> points;
    // Of this stroke, so that it goes on where the last one ended.
    Vector2d shift = Vector2d::Zero(), last = shift;
    const auto whole = [&](const Vector2d& by) {
      Vector2d out = Vector2d::Zero();
      for (int k = 0; k < 2; ++k)
        if (period_[k] > 0) out[k] = std::round(by[k] / period_[k]);
      return out;
    };
    for (const int h : half_edges) {
      const Matrix2Xd& l = lines_[h / 2];
      const int n = int(l.cols());
      const auto at = [&](int i) -> Vector2d { return l.col(h % 2 == 0 ? i : n - 1 - i); };
      if (!points.empty()) shift = whole(last - at(0)).cwiseProduct(period_);
      for (int i = 0; i + 1 < n; ++i) points.push_back(at(i) + shift);
      last = at(n - 1) + shift;
    }
    const Vector2d around = whole(last - points[0]);
    *turns = int(around.x());
    *across = int(around.y());
    Matrix2Xd polygon(2, points.size());
    for (size_t i = 0; i < points.size(); ++i) polygon.col(i) = points[i];
    return polygon;
  }

  // Number of the connected part of every member.
  std::vector<int> parts() const {
    std::vector<int> part(members_.size());
    std::iota(part.begin(), part.end(), 0);
    std::map<int, int> of_node;
    for (bool changed = true; changed;) {  // labels sink to the smallest of their part
      changed = false;
      for (int h = 0; h < int(2 * alive_.size()); ++h) {
        if (!alive_[h / 2] || closed(h / 2)) continue;
        const auto [it, first] = of_node.emplace(tail(h), part[h / 2]);
        const int low = std::min(it->second, part[h / 2]);
        changed |= low != part[h / 2] || low != it->second;
        it->second = part[h / 2] = low;
      }
    }
    return part;
  }

  const Sketch& sketch_;
  const std::vector<int>& members_;
  std::vector<bool> alive_;
  const std::vector<Matrix2Xd>& lines_;
  Vector2d period_;
};

}  // namespace

std::vector<Cycle> simple_cycles(const Sketch& sketch, const std::vector<int>& members,
                                 const std::vector<Matrix2Xd>& lines, const Vector2d& period) {
  return Graph(sketch, members, lines, period).cycles();
}

bool is_inside(const Vector2d& p, const Matrix2Xd& polygon) {
  bool inside = false;
  for (int i = 0; i < polygon.cols(); ++i) {
    const Vector2d a = polygon.col(i), b = polygon.col((i + 1) % polygon.cols());
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
  }
  return inside;
}

}  // namespace sketchsplat
