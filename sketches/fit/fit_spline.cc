// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <cmath>

#include "datasets/types/dense.h"
#include "sketches/curve/conic.h"
#include "sketches/fit/fit.h"
#include "sketches/fit/refine.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// Inner control points by linear least squares at parameters proportional to the chords; a hair of
// weight on the straight cubic makes it solvable for any points.
void start_bezier(const Matrix3Xd& points, ControlPoints* c) {
  const int n = int(points.cols());
  Eigen::VectorXd t(n);
  t[0] = (points.col(0) - c->p[0]).norm();
  for (int i = 1; i < n; ++i) t[i] = t[i - 1] + (points.col(i) - points.col(i - 1)).norm();
  t /= std::max(t[n - 1] + (points.col(n - 1) - c->p[3]).norm(), 1e-300);
  const Vector3d p1 = (2 * c->p[0] + c->p[3]) / 3, p2 = (c->p[0] + 2 * c->p[3]) / 3;
  Eigen::Matrix2d H = 1e-9 * Eigen::Matrix2d::Identity();
  Eigen::Matrix<double, 2, 3> g = Eigen::Matrix<double, 2, 3>::Zero();
  for (int i = 0; i < n; ++i) {
    const double s = 1 - t[i];
    const Eigen::Vector2d b(3 * s * s * t[i], 3 * s * t[i] * t[i]);
    const Vector3d straight =
        s * s * s * c->p[0] + t[i] * t[i] * t[i] * c->p[3] + b[0] * p1 + b[1] * p2;
    H += b * b.transpose();
    g += b * (points.col(i) - straight).transpose();
  }
  const Eigen::Matrix<double, 2, 3> x = solve_symmetric(H, g);
  c->p[1] = p1 + x.row(0).transpose();
  c->p[2] = p2 + x.row(1).transpose();
}

// Semi-axes and centre in the plane from the conic a x^2 + b xy + c y^2 + d x + e y + f = 0.
bool axes_of_conic(const Eigen::Matrix<double, 6, 1>& k, Eigen::Vector2d* centre,
                   Eigen::Matrix2d* semi_axes) {
  Eigen::Matrix2d Q;
  Q << k[0], k[1] / 2, k[1] / 2, k[2];
  if (!(Q.determinant() > 0)) return false;
  *centre = -0.5 * Q.inverse() * Eigen::Vector2d(k[3], k[4]);
  const double f = k[5] + 0.5 * (k[3] * centre->x() + k[4] * centre->y());
  const auto eigen = eigen_symmetric(Q);
  const Eigen::Vector2d squared = -f * eigen.values.cwiseInverse();
  if (!(squared.minCoeff() > 0) || !squared.allFinite()) return false;
  *semi_axes = eigen.vectors * squared.cwiseSqrt().asDiagonal();
  return true;
}

// Direct least squares fit of an ellipse, split into quadratic and linear parts (Halir, Flusser).
bool direct_ellipse(const Eigen::VectorXd& x, const Eigen::VectorXd& y, Eigen::Vector2d* centre,
                    Eigen::Matrix2d* semi_axes) {
  Eigen::MatrixXd D1(x.size(), 3), D2(x.size(), 3);
  D1 << x.cwiseAbs2(), x.cwiseProduct(y), y.cwiseAbs2();
  D2 << x, y, Eigen::VectorXd::Ones(x.size());
  const Matrix3d S1 = D1.transpose() * D1, S2 = D1.transpose() * D2, S3 = D2.transpose() * D2;
  const Matrix3d T = -solve_symmetric(S3, S2.transpose());
  const Matrix3d M = S1 + S2 * T;
  Matrix3d reduced;
  reduced << M.row(2) / 2, -M.row(1), M.row(0) / 2;
  if (!reduced.allFinite()) return false;
  const GeneralEigen eigen = eigen_general(reduced);
  double best = 0;
  Eigen::Matrix<double, 6, 1> conic;
  for (int i = 0; i < 3; ++i) {  // exactly one has a positive discriminant, rounding apart
    const Vector3d v = eigen.vectors.col(i).real();
    const double discriminant = 4 * v[0] * v[2] - v[1] * v[1];
    if (!(discriminant > best)) continue;
    best = discriminant;
    conic << v, T * v;
  }
  return best > 0 && axes_of_conic(conic, centre, semi_axes);
}

}  // namespace

bool start_ellipse(const Normalised& n, ControlPoints* c) {
  const Svd spread = svd(n.points.transpose());
  if (!(spread.values[1] > (1e-8 + 10 * n.resolution) * spread.values[0])) return false;
  const Eigen::Matrix<double, 3, 2> plane = spread.v.leftCols(2);
  // Both directions to the same spread first: the direct fit is not good at slender points.
  const Eigen::Vector2d unit = spread.values.head(2) / std::sqrt(double(n.points.cols()));
  const Eigen::Matrix2Xd flat = unit.cwiseInverse().asDiagonal() * (plane.transpose() * n.points);
  Eigen::Vector2d centre;
  Eigen::Matrix2d axes;
  if (!direct_ellipse(flat.row(0), flat.row(1), &centre, &axes)) return false;
  c->count = 3;
  c->p[0] = plane * unit.cwiseProduct(centre);
  c->p[1] = plane * unit.cwiseProduct(axes.col(0));
  c->p[2] = plane * unit.cwiseProduct(axes.col(1));
  return true;
}

BezierFit fit_bezier(const Matrix3Xd& points, const std::optional<Vector3d>& begin,
                     const std::optional<Vector3d>& end) {
  BezierFit out;
  const Normalised n = normalise(points, 4);
  if (!n.usable || (begin && !begin->allFinite()) || (end && !end->allFinite())) return out;
  ControlPoints c;
  c.count = 4;
  c.p[0] = begin ? n.apply(*begin) : n.points.col(0);
  c.p[3] = end ? n.apply(*end) : n.points.rightCols<1>();
  start_bezier(n.points, &c);
  RefineOptions options;
  options.free = {!begin, true, true, !end};
  options.begin_at_first = !begin;
  options.end_at_last = !end;
  const FitQuality quality = refine_curve(StrokeKind::kBezier, n.points, options, &c);
  if (!quality.success) return out;
  for (int k = 0; k < 4; ++k) out.control[k] = n.restore(c.p[k]);
  if (begin) out.control[0] = *begin;
  if (end) out.control[3] = *end;
  out.success = true;
  out.rms = n.scale * quality.rms;
  out.max_distance = n.scale * quality.max_distance;
  return out;
}

EllipseFit fit_ellipse(const Matrix3Xd& points) {
  EllipseFit out;
  const Normalised n = normalise(points, 6);
  ControlPoints c;
  if (!n.usable || !start_ellipse(n, &c)) return out;
  RefineOptions options;
  const FitQuality quality = refine_curve(StrokeKind::kEllipse, n.points, options, &c);
  const EllipseAxes axes = principal_axes(c.p[1], c.p[2]);
  if (!quality.success || !(axes.minor.norm() > 1e-8 * axes.major.norm())) return out;
  out.success = true;
  out.rms = n.scale * quality.rms;
  out.max_distance = n.scale * quality.max_distance;
  out.centre = n.restore(c.p[0]);
  out.u = n.scale * axes.major;
  out.v = n.scale * axes.minor;
  return out;
}

}  // namespace sketchsplat
