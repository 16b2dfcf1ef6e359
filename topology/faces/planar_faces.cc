// SPDX-License-Identifier: MIT
#include "topology/faces/planar_faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "sketches/curve/curve.h"
#include "topology/faces/find_planes.h"
#include "topology/faces/planar_loops.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

std::vector<int> strokes_of(const Loop& loop) {
  std::vector<int> out;
  for (const LoopStroke& s : loop) out.push_back(s.stroke);
  std::sort(out.begin(), out.end());
  return out;
}

// Drops faces found twice, and what is a hole elsewhere: planes that differ by less than the
// tolerance need not see the same strokes.
std::vector<PlanarFace> without_doubles(const std::vector<PlanarFace>& faces) {
  std::set<std::vector<int>> holes, outers;
  for (const PlanarFace& f : faces)
    for (const Loop& hole : f.holes) holes.insert(strokes_of(hole));
  std::vector<PlanarFace> sorted = faces, out;
  std::stable_sort(sorted.begin(), sorted.end(), [](const PlanarFace& a, const PlanarFace& b) {
    return a.holes.size() > b.holes.size();
  });
  for (const PlanarFace& f : sorted) {
    const std::vector<int> outer = strokes_of(f.outer);
    if (!holes.count(outer) && outers.insert(outer).second) out.push_back(f);
  }
  return out;
}

void flip(Loop* loop) {
  std::reverse(loop->begin(), loop->end());
  for (LoopStroke& s : *loop) s.forward = !s.forward;
}

void flip(PlanarFace* face) {
  face->normal = -face->normal;
  flip(&face->outer);
  for (Loop& hole : face->holes) flip(&hole);
}

// Uses of every stroke: face and direction.
std::map<int, std::vector<std::pair<int, bool>>> uses_of(const std::vector<PlanarFace>& faces) {
  std::map<int, std::vector<std::pair<int, bool>>> uses;
  for (int f = 0; f < int(faces.size()); ++f) {
    for (const LoopStroke& s : faces[f].outer) uses[s.stroke].emplace_back(f, s.forward);
    for (const Loop& hole : faces[f].holes)
      for (const LoopStroke& s : hole) uses[s.stroke].emplace_back(f, s.forward);
  }
  return uses;
}

// Positive if the outer loops of these faces look away from their common middle: the volume of the
// cones from the middle to the faces.
double outwardness(const std::vector<PlanarFace>& faces, const std::vector<int>& set,
                   const std::vector<Matrix3Xd>& polylines) {
  Vector3d middle = Vector3d::Zero();
  int count = 0;
  for (const int f : set)
    for (const LoopStroke& s : faces[f].outer) {
      middle += polylines[s.stroke].rowwise().mean();
      ++count;
    }
  middle /= count;
  double sum = 0;
  for (const int f : set) {
    Vector3d area = Vector3d::Zero();
    for (const LoopStroke& s : faces[f].outer) {
      const Matrix3Xd& p = polylines[s.stroke];
      for (int i = 0; i + 1 < p.cols(); ++i)
        area += (s.forward ? 0.5 : -0.5) *
                Vector3d(p.col(i) - faces[f].point).cross(Vector3d(p.col(i + 1) - faces[f].point));
    }
    sum += area.dot(faces[f].point - middle);
  }
  return sum;
}

void orient(const std::vector<Matrix3Xd>& polylines, std::vector<PlanarFace>* faces) {
  const auto uses = uses_of(*faces);
  std::vector<std::vector<std::pair<int, bool>>> beside(faces->size());  // face, same direction
  for (const auto& [stroke, of] : uses) {
    if (of.size() != 2 || of[0].first == of[1].first) continue;
    const bool same = of[0].second == of[1].second;
    beside[of[0].first].emplace_back(of[1].first, same);
    beside[of[1].first].emplace_back(of[0].first, same);
  }
  std::vector<int> turned(faces->size(), -1);
  for (int first = 0; first < int(faces->size()); ++first) {
    if (turned[first] >= 0) continue;
    std::vector<int> set = {first};
    turned[first] = 0;
    for (size_t k = 0; k < set.size(); ++k)
      for (const auto& [other, same] : beside[set[k]])
        if (turned[other] < 0) {
          turned[other] = turned[set[k]] ^ int(same);
          set.push_back(other);
        }
    for (const int f : set)
      if (turned[f]) flip(&(*faces)[f]);
    if (outwardness(*faces, set, polylines) < 0)
      for (const int f : set) flip(&(*faces)[f]);
  }
}

}  // namespace

std::vector<PlanarFace> planar_faces(const Sketch& sketch, const PlanarFaceOptions& options) {
  const double tolerance = options.tolerance * largest_extent(sketch);
  const std::vector<Matrix3Xd> polylines = polylines_of(sketch);
  std::vector<PlanarFace> faces;
  for (const auto& [plane, members] : find_planes(sketch, polylines, tolerance))
    for (const PlanarFace& face : faces_in_plane(sketch, polylines, members, plane, tolerance))
      faces.push_back(face);
  faces = without_doubles(faces);
  orient(polylines, &faces);
  return faces;
}

}  // namespace sketchsplat
