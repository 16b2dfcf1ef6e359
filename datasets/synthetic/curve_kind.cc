// SPDX-License-Identifier: MIT
#include "datasets/synthetic/curve_kind.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace sketchsplat {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// Odd, so that no sample of a closed curve lies opposite another; many, so that a B-spline of a few
// dozen spans cannot hide a wiggle between them.
constexpr int kProbes = 97;

std::vector<double> with_ends(const ParametricCurve& curve, const std::vector<double>& breaks) {
  std::vector<double> knots = {curve.first};
  for (double t : breaks)
    if (t > knots.back() && t < curve.last) knots.push_back(t);
  knots.push_back(curve.last);
  return knots;
}

Vector3d circle_centre(const Vector3d& a, const Vector3d& b, const Vector3d& c, bool* defined) {
  const Vector3d u = b - a, v = c - a, n = u.cross(v);
  *defined = n.norm() > 1e-9 * u.norm() * v.norm() && u.norm() > 0 && v.norm() > 0;
  if (!*defined) return a;
  return a + (u.squaredNorm() * v.cross(n) + v.squaredNorm() * n.cross(u)) / (2 * n.squaredNorm());
}

}  // namespace

CurveShape recognise(const ParametricCurve& curve, double tolerance) {
  Matrix3Xd p(3, kProbes);
  for (int i = 0; i < kProbes; ++i)
    p.col(i) = curve.point(curve.first + (curve.last - curve.first) * i / (kProbes - 1));
  CurveShape shape;
  const Vector3d begin = p.col(0), end = p.col(kProbes - 1);
  if ((end - begin).norm() > tolerance) {
    const Vector3d along = (end - begin).normalized();
    const Matrix3Xd from = p.colwise() - begin;
    const Matrix3Xd off = from - along * (along.transpose() * from);
    if (off.colwise().norm().maxCoeff() <= tolerance) {
      shape.kind = CurveShape::kLine;
      return shape;
    }
  }
  bool defined = false;
  const Vector3d a = p.col(0), b = p.col(kProbes / 3), c = p.col(2 * kProbes / 3);
  const Vector3d centre = circle_centre(a, b, c, &defined);
  if (!defined) return shape;
  const double radius = (a - centre).norm();
  const Vector3d normal = (a - centre).cross(b - centre).normalized();
  double turn = 0;
  for (int i = 0; i < kProbes; ++i) {
    const Vector3d r = p.col(i) - centre;
    if (std::abs(r.norm() - radius) > tolerance || std::abs(r.dot(normal)) > tolerance)
      return shape;
    if (i == 0) continue;
    const Vector3d before = p.col(i - 1) - centre;
    turn += std::atan2(before.cross(r).dot(normal), before.dot(r));
  }
  shape.kind = CurveShape::kCircular;
  shape.centre = centre;
  shape.axis = normal * radius;
  shape.turn = turn;
  return shape;
}

void hermite_handles(const ParametricCurve& curve, double a, double b, Vector3d* h0, Vector3d* h1) {
  const double inside = 1e-9 * (b - a);
  Vector3d p, q, dp, dq;
  curve.evaluate(a + inside, &p, &dp);
  curve.evaluate(b - inside, &q, &dq);
  *h0 = p + dp * (b - a) / 3;
  *h1 = q - dq * (b - a) / 3;
}

namespace {

double hermite_error(const ParametricCurve& curve, double a, double b) {
  Vector3d h0, h1;
  hermite_handles(curve, a, b, &h0, &h1);
  const Vector3d p = curve.point(a), q = curve.point(b);
  double worst = 0;
  constexpr int kSteps = 16;
  for (int i = 1; i < kSteps; ++i) {
    const double t = double(i) / kSteps, s = 1 - t;
    const Vector3d x = p * s * s * s + h0 * 3 * s * s * t + h1 * 3 * s * t * t + q * t * t * t;
    worst = std::max(worst, (x - curve.point(a + (b - a) * t)).norm());
  }
  return worst;
}

}  // namespace

std::vector<double> hermite_knots(const ParametricCurve& curve, const std::vector<double>& breaks,
                                  double tolerance) {
  std::vector<double> todo = with_ends(curve, breaks), done = {curve.first};
  constexpr int kMost = 4096;  // pieces; only a curve with a cusp would ask for more
  std::reverse(todo.begin(), todo.end());
  todo.pop_back();
  while (!todo.empty()) {
    const double a = done.back(), b = todo.back();
    if (int(done.size() + todo.size()) < kMost && hermite_error(curve, a, b) > tolerance) {
      todo.push_back((a + b) / 2);
    } else {
      done.push_back(b);
      todo.pop_back();
    }
  }
  return done;
}

Matrix3Xd polyline(const ParametricCurve& curve, const std::vector<double>& breaks,
                   double deflection, double spacing, std::vector<double>* parameters) {
  // Three probes per span, so that an S-shaped span does not pass for a straight one.
  const auto bends = [&](double a, double b) {
    const Vector3d p = curve.point(a), q = curve.point(b);
    if ((q - p).norm() > spacing) return true;
    for (double w : {0.25, 0.5, 0.75}) {
      const Vector3d x = curve.point(a + (b - a) * w) - p;
      const Vector3d along = q - p;
      const double l2 = along.squaredNorm();
      const double t = l2 > 0 ? std::clamp(x.dot(along) / l2, 0.0, 1.0) : 0.0;
      if ((x - along * t).norm() > deflection) return true;
    }
    return false;
  };
  std::vector<double> todo = with_ends(curve, breaks), done = {curve.first};
  std::reverse(todo.begin(), todo.end());
  todo.pop_back();
  const double shortest = 1e-6 * (curve.last - curve.first);
  while (!todo.empty()) {
    const double a = done.back(), b = todo.back();
    if (b - a > shortest && bends(a, b)) {
      todo.push_back((a + b) / 2);
    } else {
      done.push_back(b);
      todo.pop_back();
    }
  }
  Matrix3Xd points(3, done.size());
  for (size_t i = 0; i < done.size(); ++i) points.col(i) = curve.point(done[i]);
  if (parameters) *parameters = std::move(done);
  return points;
}

}  // namespace sketchsplat
