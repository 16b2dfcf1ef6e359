// SPDX-License-Identifier: MIT
#include "topology/planar_faces.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "sketches/curve.h"
#include "topology/planar_loops.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// The normal of a first plane is known to the tolerance over the width of its strokes.
constexpr double kLeastWidth = 10;  // tolerances

Matrix3Xd polyline_of(const Sketch& sketch, int stroke) {
  const int pieces = sketch.strokes[stroke].kind == StrokeKind::kLine ? 1 : 32;
  Matrix3Xd out(3, pieces + 1);
  Vector3d p, d;
  for (int i = 0; i <= pieces; ++i) {
    evaluate_stroke(sketch, stroke, double(i) / pieces, &p, &d);
    out.col(i) = p;
  }
  return out;
}

// Weighted sums over points, from which planes are fitted.
struct Moments {
  double weight = 0;
  Vector3d sum = Vector3d::Zero();
  Matrix3d square = Matrix3d::Zero();
  Moments& operator+=(const Moments& o) {
    weight += o.weight;
    sum += o.sum;
    square += o.square;
    return *this;
  }
};

Moments moments_of(const Matrix3Xd& points, const Vector3d& centre) {
  Moments m;
  for (int i = 0; i + 1 < points.cols(); ++i) {
    const double length = (points.col(i + 1) - points.col(i)).norm();
    for (const int k : {i, i + 1}) {
      const Vector3d p = points.col(k) - centre;
      m.weight += length / 2;
      m.sum += length / 2 * p;
      m.square += length / 2 * p * p.transpose();
    }
  }
  return m;
}

class PlaneFinder {
 public:
  PlaneFinder(const Sketch& sketch, double tolerance) : sketch_(sketch), tolerance_(tolerance) {
    for (int s = 0; s < sketch.size(); ++s) polylines.push_back(polyline_of(sketch, s));
    if (sketch.size() > 0) centre_ = polylines[0].col(0);
    neighbours_.resize(sketch.size());
    std::vector<std::vector<int>> at(sketch.nodes.cols());
    for (int s = 0; s < sketch.size(); ++s) {
      moments_.push_back(moments_of(polylines[s], centre_));
      if (is_closed(sketch.strokes[s].kind)) continue;
      at[sketch.strokes[s].begin].push_back(s);
      at[sketch.strokes[s].end].push_back(s);
    }
    for (const std::vector<int>& strokes : at)
      for (const int a : strokes)
        for (const int b : strokes)
          if (a != b) neighbours_[a].insert(b);
  }

  // Planes and the strokes in each; no set of strokes twice.
  std::vector<std::pair<Plane, std::vector<int>>> find() const {
    std::vector<std::pair<Plane, std::vector<int>>> planes;
    std::set<std::vector<int>> seen;
    std::set<std::pair<int, int>> covered;
    const auto grow_from = [&](const std::vector<int>& seed) {
      if (covered.count({seed.front(), seed.back()})) return;
      const std::optional<std::pair<Plane, std::vector<int>>> grown = grow(seed);
      if (!grown) return;
      for (const int a : grown->second)
        for (const int b : grown->second) covered.insert({a, b});
      if (seen.insert(grown->second).second) planes.push_back(*grown);
    };
    for (int a = 0; a < sketch_.size(); ++a) {
      if (sketch_.strokes[a].kind != StrokeKind::kLine) grow_from({a});
      for (const int b : neighbours_[a])
        if (a < b) grow_from({a, b});
    }
    return planes;
  }

  std::vector<Matrix3Xd> polylines;  ///< of every stroke

 private:
  std::optional<Plane> fit(const std::vector<int>& members) const {
    Moments m;
    for (const int s : members) m += moments_[s];
    const Vector3d mean = m.sum / m.weight;
    const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(m.square / m.weight -
                                                         mean * mean.transpose());
    Plane plane;
    plane.origin = centre_ + mean;
    plane.normal = solver.eigenvectors().col(0).normalized();
    plane.x = solver.eigenvectors().col(2).normalized();
    plane.y = plane.normal.cross(plane.x);
    for (const int s : members)
      if (!holds(plane, s)) return std::nullopt;
    return plane;
  }
  bool holds(const Plane& plane, int stroke) const {
    return ((polylines[stroke].colwise() - plane.origin).transpose() * plane.normal)
               .cwiseAbs()
               .maxCoeff() <= tolerance_;
  }
  double width(const Plane& plane, const std::vector<int>& members) const {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const int s : members) {
      const Eigen::VectorXd y = (polylines[s].colwise() - plane.origin).transpose() * plane.y;
      low = std::min(low, y.minCoeff());
      high = std::max(high, y.maxCoeff());
    }
    return high - low;
  }

  std::optional<std::pair<Plane, std::vector<int>>> grow(std::vector<int> members) const {
    std::optional<Plane> plane = fit(members);
    if (!plane || width(*plane, members) < kLeastWidth * tolerance_) return std::nullopt;
    std::set<int> tried(members.begin(), members.end());
    for (size_t k = 0; k < members.size(); ++k)
      for (const int next : neighbours_[members[k]]) {
        if (!tried.insert(next).second) continue;
        members.push_back(next);
        if (const std::optional<Plane> wider = fit(members))
          plane = wider;
        else
          members.pop_back();
      }
    std::vector<int> all;
    for (int s = 0; s < sketch_.size(); ++s)
      if (holds(*plane, s)) all.push_back(s);
    return std::make_pair(*plane, all);
  }

  const Sketch& sketch_;
  double tolerance_;
  Vector3d centre_ = Vector3d::Zero();
  std::vector<Moments> moments_;
  std::vector<std::set<int>> neighbours_;
};

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
  const PlaneFinder finder(sketch, tolerance);
  std::vector<PlanarFace> faces;
  for (const auto& [plane, members] : finder.find())
    for (const PlanarFace& face :
         faces_in_plane(sketch, finder.polylines, members, plane, tolerance))
      faces.push_back(face);
  faces = without_doubles(faces);
  orient(finder.polylines, &faces);
  return faces;
}

}  // namespace sketchsplat
