// SPDX-License-Identifier: MIT
#include "datasets/synthetic/cad/curve_kind.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "datasets/types/dense.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// Odd, so that no sample of a closed curve lies opposite another; many, so that a B-spline of a few
// dozen spans cannot hide a wiggle between them.
constexpr int kProbes = 97;
constexpr double kLeastTurn = 0.5;  // [rad] of an ellipse

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

bool is_line(const Matrix3Xd& p, double tolerance) {
  const Vector3d begin = p.col(0), chord = p.rightCols<1>() - p.leftCols<1>();
  if (!(chord.norm() > tolerance)) return false;
  const Matrix3Xd from = p.colwise() - begin;
  const Vector3d along = chord.normalized();
  const Matrix3Xd off = from - along * (along.transpose() * from);
  return off.colwise().norm().maxCoeff() <= tolerance;
}

// Angle of a point about the centre of an ellipse, as its parameter counts it.
double parameter(const CurveShape& e, const Vector3d& p) {
  return std::atan2((p - e.centre).dot(e.v) / e.v.squaredNorm(),
                    (p - e.centre).dot(e.u) / e.u.squaredNorm());
}

// Fills `turn` and turns v over if the points run the other way.
void set_turn(const Matrix3Xd& p, CurveShape* shape) {
  double turn = 0;
  for (Eigen::Index i = 1; i < p.cols(); ++i)
    turn += std::remainder(parameter(*shape, p.col(i)) - parameter(*shape, p.col(i - 1)), 2 * M_PI);
  if (turn < 0) shape->v = -shape->v;
  shape->turn = std::abs(turn);
}

bool is_circular(const Matrix3Xd& p, double tolerance, CurveShape* shape) {
  bool defined = false;
  const Eigen::Index third = p.cols() / 3;
  const Vector3d a = p.col(0), b = p.col(third), c = p.col(2 * third);
  const Vector3d centre = circle_centre(a, b, c, &defined);
  if (!defined) return false;
  const double radius = (a - centre).norm();
  const Vector3d normal = (b - a).cross(c - a).normalized();
  for (Eigen::Index i = 0; i < p.cols(); ++i) {
    const Vector3d r = p.col(i) - centre;
    if (std::abs(r.norm() - radius) > tolerance || std::abs(r.dot(normal)) > tolerance)
      return false;
  }
  shape->centre = centre;
  shape->u = a - centre;
  shape->v = normal.cross(shape->u);
  set_turn(p, shape);
  return true;
}

// The conic through planar points (x, y) by least squares: x^2, xy, y^2, x, y, 1.
Eigen::Matrix<double, 6, 1> fit_conic(const Eigen::Matrix2Xd& q) {
  Eigen::Matrix<double, Eigen::Dynamic, 6> rows(q.cols(), 6);
  for (Eigen::Index i = 0; i < q.cols(); ++i) {
    const double x = q(0, i), y = q(1, i);
    rows.row(i) << x * x, x * y, y * y, x, y, 1;
  }
  return svd(rows).v.col(5);
}

// Half-axes as columns, the longer one first; false if the conic is no ellipse.
bool half_axes(const Eigen::Matrix<double, 6, 1>& k, Eigen::Vector2d* centre,
               Eigen::Matrix2d* axes) {
  Eigen::Matrix2d A;
  A << k[0], k[1] / 2, k[1] / 2, k[2];
  if (!(A.determinant() > 1e-9 * A.squaredNorm())) return false;
  const Eigen::Vector2d b(k[3] / 2, k[4] / 2);
  *centre = -A.inverse() * b;
  const double level = -(k[5] + b.dot(*centre));
  const auto solver = eigen_symmetric(A / level);
  if (!(solver.values.minCoeff() > 0)) return false;
  *axes = solver.vectors * solver.values.cwiseSqrt().cwiseInverse().asDiagonal();
  return true;
}

bool is_elliptic(const Matrix3Xd& p, double tolerance, CurveShape* shape) {
  const Vector3d mean = p.rowwise().mean();
  const Matrix3Xd from = p.colwise() - mean;
  const auto spread = eigen_symmetric(from * from.transpose());
  if ((spread.vectors.col(0).transpose() * from).cwiseAbs().maxCoeff() > tolerance) return false;
  Eigen::Matrix<double, 3, 2> plane;
  plane << spread.vectors.col(2), spread.vectors.col(1);
  const double scale = from.colwise().norm().maxCoeff();
  Eigen::Vector2d centre;
  Eigen::Matrix2d axes;
  if (!half_axes(fit_conic(plane.transpose() * from / scale), &centre, &axes)) return false;
  shape->centre = mean + plane * centre * scale;
  shape->u = plane * axes.col(0) * scale;
  shape->v = plane * axes.col(1) * scale;
  for (Eigen::Index i = 0; i < p.cols(); ++i) {
    // Distance to first order: the excess of the radius over that of the ellipse, by its gradient.
    const Vector3d r = p.col(i) - shape->centre;
    const double x = r.dot(shape->u) / shape->u.squaredNorm();
    const double y = r.dot(shape->v) / shape->v.squaredNorm();
    const double slope = 2 * std::hypot(x / shape->u.norm(), y / shape->v.norm());
    if (!(std::abs(x * x + y * y - 1) <= tolerance * slope)) return false;
  }
  set_turn(p, shape);
  return true;
}

}  // namespace

CurveShape recognise(const ParametricCurve& curve, double tolerance) {
  Matrix3Xd p(3, kProbes);
  for (int i = 0; i < kProbes; ++i)
    p.col(i) = curve.point(curve.first + (curve.last - curve.first) * i / (kProbes - 1));
  CurveShape shape;
  if (is_line(p, tolerance))
    shape.kind = CurveShape::kLine;
  else if (is_circular(p, tolerance, &shape))
    shape.kind = CurveShape::kCircular;
  else if (is_elliptic(p, tolerance, &shape) && shape.turn >= kLeastTurn)
    shape.kind = CurveShape::kElliptic;
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
