// SPDX-License-Identifier: MIT
#include "topology/faces/planar_loops.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "topology/faces/stroke_graph.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Vector2d;

double perimeter(const Matrix2Xd& polygon) {
  double length = 0;
  for (int i = 0; i < polygon.cols(); ++i)
    length += (polygon.col((i + 1) % polygon.cols()) - polygon.col(i)).norm();
  return length;
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

// The smallest counter-clockwise cycle of another part around this one, larger than this one; -1 if
// there is none. Of two parts that cross, each may have most of the other inside.
int container(const std::vector<Cycle>& cycles, const Cycle& inner) {
  int best = -1;
  for (int i = 0; i < int(cycles.size()); ++i) {
    const Cycle& c = cycles[i];
    if (c.part == inner.part || c.area <= -inner.area) continue;
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
  Eigen::Matrix<double, 2, 3> project;
  project << plane.x.transpose(), plane.y.transpose();
  std::vector<Matrix2Xd> lines;
  for (const int m : members) lines.push_back(project * (polylines[m].colwise() - plane.origin));
  const std::vector<Cycle> cycles = simple_cycles(sketch, members, lines);
  // What lies around every part, by the clockwise walk along its outside.
  std::map<int, int> around;
  std::vector<bool> walk_has_inside(2 * members.size() + 1);
  for (const Cycle& c : cycles)
    if (c.area > 0) walk_has_inside[c.walk] = true;
  for (const Cycle& c : cycles)
    if (c.area <= 0 && !walk_has_inside[c.walk]) around.emplace(c.part, container(cycles, c));
  const auto depth = [&](int part) {
    int count = 0;
    // Areas grow from part to part, so this ends; of strokes that cross they need not.
    auto it = around.find(part);
    for (; it != around.end() && it->second >= 0 && count < int(cycles.size()); ++count)
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
