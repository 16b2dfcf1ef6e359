// SPDX-License-Identifier: MIT
#include "eval/inspect/feature.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "datasets/types/dense.h"
#include "eval/inspect/stroke_errors.h"
#include "sketches/curve/curve.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kPlaces = 13;           // of a stroke
constexpr double kLeastWidth = 0.02;  // of a plane's points, over their length
constexpr double kLeastFound = 0.5;   // of an edge, that it be a feature

// Circle through points of a plane: Kasa's linear least squares, exact on circles.
void fit_circle(const Matrix3Xd& points, const VectorXd& weights, Feature* f) {
  const Vector3d x = f->direction.unitOrthogonal(), y = f->direction.cross(x);
  Matrix3d a = Matrix3d::Zero();
  Vector3d b = Vector3d::Zero();
  for (int i = 0; i < points.cols(); ++i) {
    const Vector3d d = points.col(i) - f->point;
    const Vector3d row(d.dot(x), d.dot(y), 1);
    a += weights[i] * row * row.transpose();
    b += weights[i] * row * (row.x() * row.x() + row.y() * row.y());
  }
  const Vector3d c = solve_symmetric(a, b);
  const double r2 = c.z() + (c.x() * c.x() + c.y() * c.y()) / 4;
  f->ok = f->ok && c.allFinite() && r2 > 0;
  f->point += c.x() / 2 * x + c.y() / 2 * y;
  f->radius = std::sqrt(std::max(0.0, r2));
}

struct Points {
  Matrix3Xd position;
  VectorXd weights;
};

const std::vector<int>& edges_of(const Nominal& nominal, const FeatureRef& ref,
                                 std::vector<int>* own) {
  if (ref.kind == FeatureKind::kPlane) return nominal.planes[ref.index].edges;
  *own = {ref.index};
  return *own;
}

// The direction by which the feature's is turned to its side.
Vector3d side_of(const Nominal& nominal, const FeatureRef& ref) {
  if (ref.kind == FeatureKind::kPlane) return nominal.planes[ref.index].normal;
  NominalCircle circle;
  if (ref.kind == FeatureKind::kCircle && circle_of(nominal, ref.index, &circle))
    return circle.normal;
  const NominalEdge& e = nominal.edges[ref.index];
  Vector3d p, d;
  evaluate_stroke(nominal.sketch, e.strokes[0], 0.5, &p, &d);
  return d;
}

// Places beside a few strokes, at most kPlaces each.
std::vector<EdgePlace> measured_places(const Association& association,
                                       const std::vector<int>& edges) {
  std::vector<EdgePlace> out;
  for (const int e : edges) {
    std::map<int, std::vector<EdgePlace>> by_stroke;
    for (const EdgePlace& p : association.edges[e].places)
      if (p.stroke >= 0) by_stroke[p.stroke].push_back(p);
    for (const auto& [stroke, places] : by_stroke) {
      const int n = std::min(kPlaces, int(places.size()));
      for (int i = 0; i < n; ++i) {
        EdgePlace p = places[n > 1 ? i * (places.size() - 1) / size_t(n - 1) : 0];
        p.length *= double(places.size()) / n;
        out.push_back(p);
      }
    }
  }
  return out;
}

bool is_measured(const Association& association, const std::vector<int>& edges) {
  double found = 0, all = 0;
  for (const int e : edges)
    for (const EdgePlace& p : association.edges[e].places) {
      all += p.length;
      if (p.stroke >= 0) found += p.length;
    }
  return found >= kLeastFound * all;
}

}  // namespace

Feature fit_feature(FeatureKind kind, const Matrix3Xd& points, const VectorXd& weights,
                    const Vector3d& along) {
  Feature f;
  if (points.cols() < 2) return f;
  f.point = points * weights / weights.sum();
  const Matrix3Xd d = points.colwise() - f.point;
  const auto es = eigen_symmetric(d * weights.asDiagonal() * d.transpose());
  const Vector3d spread = es.values.cwiseMax(0).cwiseSqrt();
  f.direction = es.vectors.col(kind == FeatureKind::kLine ? 2 : 0);
  if (f.direction.dot(along) < 0) f.direction = -f.direction;
  f.ok = kind == FeatureKind::kLine ? spread[2] > 0 : spread[1] > kLeastWidth * spread[2];
  if (kind == FeatureKind::kCircle) fit_circle(points, weights, &f);
  return f;
}

Feature nominal_feature(const Nominal& nominal, const Association& association,
                        const FeatureRef& ref) {
  std::vector<int> own;
  std::vector<const EdgePlace*> places;
  for (const int e : edges_of(nominal, ref, &own))
    for (const EdgePlace& p : association.edges[e].places) places.push_back(&p);
  Points points{Matrix3Xd(3, places.size()), VectorXd(places.size())};
  for (size_t i = 0; i < places.size(); ++i) {
    points.position.col(i) = places[i]->nominal;
    points.weights[i] = places[i]->length;
  }
  return fit_feature(ref.kind, points.position, points.weights, side_of(nominal, ref));
}

MeasuredFeature measured_feature(const Nominal& nominal, const Association& association,
                                 const Sketch& measured, const SigmaModel& sigma,
                                 const FeatureRef& ref) {
  MeasuredFeature out;
  std::vector<int> own;
  const std::vector<int>& edges = edges_of(nominal, ref, &own);
  if (!is_measured(association, edges)) return out;
  const std::vector<EdgePlace> places = measured_places(association, edges);
  Matrix3Xd points(3, places.size());
  VectorXd weights(places.size());
  std::map<int, std::vector<int>> of_stroke;
  for (size_t i = 0; i < places.size(); ++i) {
    points.col(i) = places[i].measured;
    weights[i] = places[i].length;
    of_stroke[places[i].stroke].push_back(int(i));
  }
  const Vector3d side = side_of(nominal, ref);
  out.value = fit_feature(ref.kind, points, weights, side);
  if (!out.value.ok) return out;
  for (const auto& [stroke, members] : of_stroke) {
    const StrokeErrors errors(measured, sigma, stroke);
    out.shares = worse_of(out.shares, of_kind(sigma.options, measured.strokes[stroke].kind).shares);
    std::vector<Eigen::Matrix<double, 3, kErrorsOfStroke>> moves;
    for (const int i : members) moves.push_back(errors.at(places[i].t));
    for (int k = 0; k < kErrorsOfStroke; ++k) {
      Matrix3Xd moved = points;
      double largest = 0;
      for (size_t i = 0; i < members.size(); ++i) {
        moved.col(members[i]) += moves[i].col(k);
        largest = std::max(largest, moves[i].col(k).squaredNorm());
      }
      if (!(largest > 0)) continue;
      out.errors.push_back({stroke * kErrorsOfStroke + k, k >= kErrorsOfEdgels,
                            fit_feature(ref.kind, moved, weights, side)});
    }
  }
  return out;
}

}  // namespace sketchsplat
