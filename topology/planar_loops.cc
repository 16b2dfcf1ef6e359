// SPDX-License-Identifier: MIT
#include "topology/planar_loops.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace sketchsplat {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Vector2d;

// A simple closed walk and the closed polygon of its points.
struct Cycle {
  Loop loop;
  Matrix2Xd polygon;
  double area = 0;  ///< positive if counter-clockwise
  int part = -1;    ///< connected part of the graph
  int walk = -1;    ///< walk of the graph that it was cut from
};

double signed_area(const Matrix2Xd& polygon) {
  double twice = 0;
  const Vector2d o = polygon.col(0);
  for (int i = 0; i < polygon.cols(); ++i) {
    const Vector2d a = polygon.col(i) - o, b = polygon.col((i + 1) % polygon.cols()) - o;
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

double perimeter(const Matrix2Xd& polygon) {
  double length = 0;
  for (int i = 0; i < polygon.cols(); ++i)
    length += (polygon.col((i + 1) % polygon.cols()) - polygon.col(i)).norm();
  return length;
}

// Crossings of a ray to the right.
bool is_inside(const Vector2d& p, const Matrix2Xd& polygon) {
  bool inside = false;
  for (int i = 0; i < polygon.cols(); ++i) {
    const Vector2d a = polygon.col(i), b = polygon.col((i + 1) % polygon.cols());
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
  }
  return inside;
}

double side_of(const Vector2d& a, const Vector2d& b, const Vector2d& p) {
  return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
}

bool segments_cross(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  if (std::max(a.x(), b.x()) < std::min(c.x(), d.x()) ||
      std::max(c.x(), d.x()) < std::min(a.x(), b.x()) ||
      std::max(a.y(), b.y()) < std::min(c.y(), d.y()) ||
      std::max(c.y(), d.y()) < std::min(a.y(), b.y()))
    return false;
  return side_of(a, b, c) * side_of(a, b, d) < 0 && side_of(c, d, a) * side_of(c, d, b) < 0;
}

bool polygons_cross(const Matrix2Xd& p, const Matrix2Xd& q, bool same) {
  for (int i = 0; i < p.cols(); ++i)
    for (int k = same ? i + 1 : 0; k < q.cols(); ++k)
      if (segments_cross(p.col(i), p.col((i + 1) % p.cols()), q.col(k), q.col((k + 1) % q.cols())))
        return true;
  return false;
}

// Strokes of one plane as a graph whose edges are walked in both directions: half-edge 2 m is the
// member m forward, 2 m + 1 backward.
class Graph {
 public:
  Graph(const Sketch& sketch, const std::vector<Eigen::Matrix3Xd>& polylines,
        const std::vector<int>& members, const Plane& plane)
      : sketch_(sketch), members_(members), alive_(members.size(), true) {
    Eigen::Matrix<double, 2, 3> project;
    project << plane.x.transpose(), plane.y.transpose();
    for (const int m : members) lines_.push_back(project * (polylines[m].colwise() - plane.origin));
  }

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
        c.polygon = polygon_of(simple);
        c.area = signed_area(c.polygon);
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

  Matrix2Xd polygon_of(const std::vector<int>& half_edges) const {
    std::vector<Vector2d> points;
    for (const int h : half_edges) {
      const Matrix2Xd& l = lines_[h / 2];
      for (int i = 0; i + 1 < l.cols(); ++i)
        points.push_back(l.col(h % 2 == 0 ? i : l.cols() - 1 - i));
    }
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
  std::vector<Matrix2Xd> lines_;
};

// The smallest counter-clockwise cycle of another part around this one; -1 if there is none.
int container(const std::vector<Cycle>& cycles, const Cycle& inner) {
  int best = -1;
  for (int i = 0; i < int(cycles.size()); ++i) {
    const Cycle& c = cycles[i];
    if (c.part == inner.part || c.area <= 0) continue;
    if (best >= 0 && c.area >= cycles[best].area) continue;
    const int n = int(inner.polygon.cols());
    int inside = 0;
    for (const int k : {0, n / 3, 2 * n / 3}) {
      const Vector2d middle = (inner.polygon.col(k) + inner.polygon.col((k + 1) % n)) / 2;
      inside += is_inside(middle, c.polygon);
    }
    if (inside >= 2) best = i;
  }
  return best;
}

bool is_clean(const std::vector<Cycle>& cycles, int outer, const std::vector<int>& holes) {
  std::vector<int> all = holes;
  all.push_back(outer);
  for (size_t i = 0; i < all.size(); ++i)
    for (size_t k = i; k < all.size(); ++k)
      if (polygons_cross(cycles[all[i]].polygon, cycles[all[k]].polygon, i == k)) return false;
  return true;
}

}  // namespace

std::vector<PlanarFace> faces_in_plane(const Sketch& sketch,
                                       const std::vector<Eigen::Matrix3Xd>& polylines,
                                       const std::vector<int>& members, const Plane& plane,
                                       double tolerance) {
  const std::vector<Cycle> cycles = Graph(sketch, polylines, members, plane).cycles();
  // What lies around every part, by the clockwise walk along its outside.
  std::map<int, int> around;
  std::vector<bool> walk_has_inside(2 * members.size() + 1);
  for (const Cycle& c : cycles)
    if (c.area > 0) walk_has_inside[c.walk] = true;
  for (const Cycle& c : cycles)
    if (c.area <= 0 && !walk_has_inside[c.walk]) around.emplace(c.part, container(cycles, c));
  const auto depth = [&](int part) {
    int count = 0;
    // Areas grow from part to part, so this ends.
    for (auto it = around.find(part); it != around.end() && it->second >= 0; ++count)
      it = around.find(cycles[it->second].part);
    return count;
  };
  std::vector<PlanarFace> faces;
  for (int i = 0; i < int(cycles.size()); ++i) {
    const Cycle& outer = cycles[i];
    if (outer.area <= 0 || depth(outer.part) % 2 != 0) continue;
    if (outer.area <= 2 * tolerance * perimeter(outer.polygon)) continue;
    std::vector<int> holes;
    for (int k = 0; k < int(cycles.size()); ++k) {
      const Cycle& c = cycles[k];
      if (c.area > 0) continue;
      const auto it = around.find(c.part);
      const bool inside = !walk_has_inside[c.walk] && it != around.end() && it->second == i;
      if (inside || c.walk == outer.walk) holes.push_back(k);
    }
    if (!is_clean(cycles, i, holes)) continue;
    PlanarFace face{plane.origin, plane.normal, outer.loop, {}};
    for (const int k : holes) face.holes.push_back(cycles[k].loop);
    faces.push_back(face);
  }
  return faces;
}

}  // namespace sketchsplat
