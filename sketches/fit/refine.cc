// SPDX-License-Identifier: MIT
#include "sketches/fit/refine.h"

#include <ceres/jet.h>

#include <cmath>

#include "datasets/types/dense.h"
#include "sketches/curve/closest.h"
#include "sketches/curve/curve.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Jet12 = ceres::Jet<double, 12>;
using Vector12d = Eigen::Matrix<double, 12, 1>;
using Matrix12d = Eigen::Matrix<double, 12, 12>;

struct Projection {
  Eigen::VectorXd t, distance;
};

Projection project(StrokeKind kind, const Matrix3Xd& points, const RefineOptions& options,
                   const ControlPoints& c) {
  const int n = int(points.cols());
  Projection out{Eigen::VectorXd(n), Eigen::VectorXd(n)};
  for (int i = 0; i < n; ++i) {
    const bool at_begin = i == 0 && options.begin_at_first;
    if (at_begin || (i == n - 1 && options.end_at_last)) {
      Vector3d p, d;
      out.t[i] = at_begin ? 0 : 1;
      evaluate_curve<double>(kind, c.p.data(), out.t[i], &p, &d);
      out.distance[i] = (points.col(i) - p).norm();
    } else {
      const ClosestPoint nearest = closest_on_curve(kind, c.p.data(), points.col(i));
      out.t[i] = nearest.t;
      out.distance[i] = nearest.distance;
    }
  }
  return out;
}

// Normal equations of the distances square to the curve (whole distances at its ends).
void accumulate(StrokeKind kind, const Vector3d& point, double t, const ControlPoints& c,
                Matrix12d* H, Vector12d* g) {
  Vec3<Jet12> control[4], position, derivative;
  for (int i = 0; i < c.count; ++i)
    for (int k = 0; k < 3; ++k) control[i][k] = Jet12(c.p[i][k], 3 * i + k);
  evaluate_curve<Jet12>(kind, control, t, &position, &derivative);
  Eigen::Matrix<double, 3, 12> J;
  Vector3d r, tangent;
  for (int k = 0; k < 3; ++k) {
    J.row(k) = position[k].v.transpose();
    r[k] = point[k] - position[k].a;
    tangent[k] = derivative[k].a;
  }
  const bool at_end = !is_closed(kind) && (t <= 0 || t >= 1);
  if (!at_end) {
    const Vector3d u = tangent.stableNormalized();
    J -= (u * (u.transpose() * J)).eval();
    r -= u * u.dot(r);
  }
  H->noalias() += J.transpose().lazyProduct(J);
  g->noalias() += J.transpose().lazyProduct(r);
}

// One damped step; the damping grows with the sum of the diagonal, so that directions in which the
// curve only slides along itself stay put.
Vector12d step(const Matrix12d& H, const Vector12d& g, const RefineOptions& options,
               double lambda) {
  Matrix12d A = H;
  A.diagonal() += lambda * (H.diagonal() + Vector12d::Constant(H.trace() / 12 + 1e-300));
  Vector12d b = g;
  for (int i = 0; i < 12; ++i)
    if (!options.free[i / 3]) {
      A.row(i).setZero();
      A.col(i).setZero();
      A(i, i) = 1;
      b[i] = 0;
    }
  return solve_symmetric(A, b);
}

}  // namespace

Normalised normalise(const Matrix3Xd& points, int at_least) {
  Normalised out;
  if (points.cols() < at_least || points.cols() == 0 || !points.allFinite()) return out;
  out.shift = points.rowwise().mean();
  const Matrix3Xd centred = points.colwise() - out.shift;
  const double largest = centred.cwiseAbs().maxCoeff();
  if (!(largest > 1e-13 * points.cwiseAbs().maxCoeff())) return out;
  out.scale = largest * std::sqrt((centred / largest).colwise().squaredNorm().mean());
  out.points = centred / out.scale;
  out.resolution = 1e-15 * (1 + out.shift.cwiseAbs().maxCoeff() / out.scale);
  out.usable = out.points.allFinite();
  return out;
}

FitQuality quality_of(const Eigen::VectorXd& distances) {
  FitQuality out;
  out.success = distances.allFinite();
  if (!out.success || distances.size() == 0) return out;
  out.rms = std::sqrt(distances.squaredNorm() / double(distances.size()));
  out.max_distance = distances.cwiseAbs().maxCoeff();
  return out;
}

FitQuality refine_curve(StrokeKind kind, const Matrix3Xd& points, const RefineOptions& options,
                        ControlPoints* control) {
  constexpr int kSteps = 60;
  const double nothing = 1e-26 * double(points.cols());  // points are normalised
  Projection now = project(kind, points, options, *control);
  double lambda = 1e-3;
  for (int i = 0; i < kSteps && lambda < 1e8; ++i) {
    const double cost = now.distance.squaredNorm();
    if (cost <= nothing) break;
    Matrix12d H = Matrix12d::Zero();
    Vector12d g = Vector12d::Zero();
    for (int k = 0; k < points.cols(); ++k)
      accumulate(kind, points.col(k), now.t[k], *control, &H, &g);
    const Vector12d delta = step(H, g, options, lambda);
    ControlPoints moved = *control;
    for (int k = 0; k < moved.count; ++k) moved.p[k] += delta.segment<3>(3 * k);
    const Projection then = project(kind, points, options, moved);
    const double moved_cost = then.distance.squaredNorm();
    if (!(moved_cost < cost)) {
      lambda *= 10;
      continue;
    }
    *control = moved;
    now = then;
    lambda = std::max(lambda * 0.1, 1e-12);
    if (cost - moved_cost < 1e-13 * cost) break;
  }
  return quality_of(now.distance);
}

}  // namespace sketchsplat
