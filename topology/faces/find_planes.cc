// SPDX-License-Identifier: MIT
#include "topology/faces/find_planes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "datasets/types/dense.h"
#include "sketches/curve/curve.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// The normal of a first plane is known to the tolerance over the width of its strokes.
constexpr double kLeastWidth = 10;  // tolerances

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

Matrix3Xd polyline_of(const Sketch& sketch, int stroke, int bent_pieces) {
  const int pieces = sketch.strokes[stroke].kind == StrokeKind::kLine ? 1 : bent_pieces;
  Matrix3Xd out(3, pieces + 1);
  Vector3d p, d;
  for (int i = 0; i <= pieces; ++i) {
    evaluate_stroke(sketch, stroke, double(i) / pieces, &p, &d);
    out.col(i) = p;
  }
  return out;
}

class PlaneFinder {
 public:
  PlaneFinder(const Sketch& sketch, const std::vector<Matrix3Xd>& polylines, double tolerance)
      : sketch_(sketch), polylines_(polylines), tolerance_(tolerance) {
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
  std::vector<PlaneStrokes> find() const {
    std::vector<PlaneStrokes> planes;
    std::set<std::vector<int>> seen;
    std::set<std::pair<int, int>> covered;
    const auto grow_from = [&](const std::vector<int>& seed) {
      if (covered.count({seed.front(), seed.back()})) return;
      const std::optional<PlaneStrokes> grown = grow(seed);
      if (!grown) return;
      for (const int a : grown->strokes)
        for (const int b : grown->strokes) covered.insert({a, b});
      if (seen.insert(grown->strokes).second) planes.push_back(*grown);
    };
    for (int a = 0; a < sketch_.size(); ++a) {
      if (sketch_.strokes[a].kind != StrokeKind::kLine) grow_from({a});
      for (const int b : neighbours_[a])
        if (a < b) grow_from({a, b});
    }
    return planes;
  }

 private:
  std::optional<Plane> fit(const std::vector<int>& members) const {
    Moments m;
    for (const int s : members) m += moments_[s];
    const Vector3d mean = m.sum / m.weight;
    const auto solver = eigen_symmetric(m.square / m.weight - mean * mean.transpose());
    Plane plane;
    plane.origin = centre_ + mean;
    plane.normal = solver.vectors.col(0).normalized();
    plane.x = solver.vectors.col(2).normalized();
    plane.y = plane.normal.cross(plane.x);
    for (const int s : members)
      if (!holds(plane, s)) return std::nullopt;
    return plane;
  }
  bool holds(const Plane& plane, int stroke) const {
    return ((polylines_[stroke].colwise() - plane.origin).transpose() * plane.normal)
               .cwiseAbs()
               .maxCoeff() <= tolerance_;
  }
  double width(const Plane& plane, const std::vector<int>& members) const {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const int s : members) {
      const Eigen::VectorXd y = (polylines_[s].colwise() - plane.origin).transpose() * plane.y;
      low = std::min(low, y.minCoeff());
      high = std::max(high, y.maxCoeff());
    }
    return high - low;
  }

  std::optional<PlaneStrokes> grow(std::vector<int> members) const {
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
    return PlaneStrokes{*plane, all};
  }

  const Sketch& sketch_;
  const std::vector<Matrix3Xd>& polylines_;
  double tolerance_;
  Vector3d centre_ = Vector3d::Zero();
  std::vector<Moments> moments_;
  std::vector<std::set<int>> neighbours_;
};

}  // namespace

std::vector<Matrix3Xd> polylines_of(const Sketch& sketch, int pieces) {
  std::vector<Matrix3Xd> lines;
  for (int s = 0; s < sketch.size(); ++s) lines.push_back(polyline_of(sketch, s, pieces));
  return lines;
}

std::vector<PlaneStrokes> find_planes(const Sketch& sketch, const std::vector<Matrix3Xd>& polylines,
                                      double tolerance) {
  return PlaneFinder(sketch, polylines, tolerance).find();
}

}  // namespace sketchsplat
