// SPDX-License-Identifier: MIT
#include "topology/faces/planar_loops.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "topology/faces/pieces.h"

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

bool is_clean(const std::vector<Matrix2Xd>& polygons) {
  for (size_t i = 0; i < polygons.size(); ++i)
    for (size_t k = i; k < polygons.size(); ++k)
      if (polygons_cross(polygons[i], polygons[k], i == k)) return false;
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
  const std::vector<SurfacePiece> pieces =
      pieces_of(cycles, Vector2d::Zero(), [](int) { return NAN; });
  std::map<int, int> around;  // of a part: the part in a piece of which it lies
  for (const SurfacePiece& piece : pieces)
    for (const int c : piece.cycles) {
      const int outer = cycles[piece.cycles[0]].part;
      if (cycles[c].part != outer) around.emplace(cycles[c].part, outer);
    }
  const auto depth = [&](int part) {
    int count = 0;
    // Areas grow from part to part, so this ends; of strokes that cross they need not.
    for (auto it = around.find(part); it != around.end() && count < int(cycles.size()); ++count)
      it = around.find(it->second);
    return count;
  };
  std::vector<PlanarFace> faces;
  for (const SurfacePiece& piece : pieces) {
    const Cycle& outer = cycles[piece.cycles[0]];
    if (depth(outer.part) % 2 != 0) continue;
    if (outer.area <= 2 * tolerance * perimeter(outer.polygon) || !is_clean(piece.polygons))
      continue;
    faces.push_back({plane.origin, plane.normal, outer.loop, {}});
    for (size_t k = 1; k < piece.cycles.size(); ++k)
      faces.back().holes.push_back(cycles[piece.cycles[k]].loop);
  }
  return faces;
}

}  // namespace sketchsplat
