// SPDX-License-Identifier: MIT
#include "sketches/fit/run_fit.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "datasets/types/dense.h"
#include "sketches/curve/closest.h"
#include "sketches/curve/conic.h"
#include "sketches/fit/ellipse_run.h"
#include "sketches/fit/fit.h"

namespace sketchsplat {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

RunFit line_through(const Matrix3Xd& p) {
  RunFit out;
  const Vector3d c = p.rowwise().mean();
  const Matrix3Xd q = p.colwise() - c;
  const auto es = eigen_symmetric(q * q.transpose());
  Vector3d u = es.vectors.col(2);
  if (u.dot(p.col(p.cols() - 1) - p.col(0)) < 0) u = -u;
  double lo = 1e300, hi = -1e300;
  out.distance.resize(p.cols());
  for (int i = 0; i < q.cols(); ++i) {
    const double s = u.dot(q.col(i));
    lo = std::min(lo, s), hi = std::max(hi, s);
    out.distance[i] = (q.col(i) - s * u).norm();
  }
  out.begin = c + lo * u, out.end = c + hi * u;
  return out;
}

namespace {

struct RunCircle {
  Vector3d centre, normal;
  double radius = 0;
  bool ok = false;
};

// Plane from positions and tangents (a short arc bends too little for positions alone), then
// Kasa's algebraic circle in it, sharpened by Gauss-Newton on the distances.
RunCircle circle_through(const Matrix3Xd& p, const Matrix3Xd& t) {
  RunCircle fit;
  const Vector3d c = p.rowwise().mean();
  const Matrix3Xd q = p.colwise() - c;
  const double spread = std::sqrt(q.squaredNorm() / q.cols());
  if (!(spread > 0)) return fit;
  const Eigen::Matrix3d M = q * q.transpose() / (spread * spread) + t * t.transpose();
  const auto es = eigen_symmetric(M);
  fit.normal = es.vectors.col(0);
  const Vector3d x = es.vectors.col(2), y = fit.normal.cross(x);
  Eigen::MatrixXd A(p.cols(), 3);
  Eigen::VectorXd b(p.cols());
  for (int i = 0; i < p.cols(); ++i) {
    const double u = x.dot(q.col(i)) / spread, v = y.dot(q.col(i)) / spread;
    A.row(i) << 2 * u, 2 * v, 1;
    b[i] = u * u + v * v;
  }
  Vector3d s = least_squares(A, b);
  double r = std::sqrt(std::max(0.0, s[2] + s[0] * s[0] + s[1] * s[1]));
  for (int it = 0; it < 8; ++it) {
    Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
    Vector3d g = Vector3d::Zero();
    for (int i = 0; i < p.cols(); ++i) {
      const double u = A(i, 0) / 2 - s[0], v = A(i, 1) / 2 - s[1], d = std::hypot(u, v);
      if (!(d > 0)) continue;
      const Vector3d j(-u / d, -v / d, -1);
      H += j * j.transpose();
      g += j * (d - r);
    }
    const Vector3d step = solve_symmetric(H + 1e-12 * Eigen::Matrix3d::Identity(), g);
    s[0] -= step[0], s[1] -= step[1], r -= step[2];
  }
  fit.centre = c + spread * (s[0] * x + s[1] * y);
  fit.radius = spread * r;
  fit.ok = std::isfinite(fit.radius) && fit.radius > 0 && fit.centre.allFinite() && r < 200;
  return fit;
}

// Signed angle by which a run goes around an axis.
double sweep_about(const Matrix3Xd& p, const Vector3d& centre, const Vector3d& normal) {
  double sweep = 0;
  for (int i = 1; i < p.cols(); ++i) {
    const Vector3d a = p.col(i - 1) - centre, b = p.col(i) - centre;
    const Vector3d u = a - a.dot(normal) * normal, v = b - b.dot(normal) * normal;
    sweep += std::atan2(u.cross(v).dot(normal), u.dot(v));
  }
  return sweep;
}

}  // namespace

RunFit arc_through(const Matrix3Xd& p, const Matrix3Xd& t, bool closed, double closing) {
  RunFit out;
  const RunCircle fit = circle_through(p, t);
  if (!fit.ok) return out;
  // Tells full circles from arcs, and the side of the apex.
  const double sweep = sweep_about(p, fit.centre, fit.normal);
  const double gap = 2 * M_PI - std::abs(sweep);
  const bool full = closed || gap * fit.radius < closing || gap < 0.2;
  if (full && std::abs(sweep) < 5) return out;  // closed, but not around the centre
  out.distance.resize(p.cols());
  for (int i = 0; i < p.cols(); ++i) {
    const Vector3d v = p.col(i) - fit.centre;
    const double h = v.dot(fit.normal);
    out.distance[i] = std::hypot(h, (v - h * fit.normal).norm() - fit.radius);
  }
  if (full) {
    out.kind = StrokeKind::kCircle;
    out.handles = {fit.centre, fit.normal * fit.radius};
    return out;
  }
  const auto on_circle = [&](const Vector3d& q) {
    const Vector3d v = q - fit.centre;
    return Vector3d(fit.centre + (v - v.dot(fit.normal) * fit.normal).normalized() * fit.radius);
  };
  out.kind = StrokeKind::kArc;
  out.begin = on_circle(p.col(0)), out.end = on_circle(p.col(p.cols() - 1));
  const Vector3d start = out.begin - fit.centre;
  out.handles = {fit.centre + Eigen::AngleAxisd(sweep / 2, fit.normal) * start};
  return out;
}

RunFit cubic_through(const Matrix3Xd& p) {
  RunFit out;
  const int n = int(p.cols());
  if (n < 6) return out;
  out.kind = StrokeKind::kBezier;
  std::vector<double> t(n, 0.0);
  for (int i = 1; i < n; ++i) t[i] = t[i - 1] + (p.col(i) - p.col(i - 1)).norm();
  if (!(t[n - 1] > 0)) return out;
  for (double& v : t) v /= t[n - 1];
  Eigen::Matrix<double, 3, 4> c;
  out.distance.resize(n);
  for (int it = 0; it < 6; ++it) {
    Eigen::MatrixXd B(n, 4);
    for (int i = 0; i < n; ++i) {
      const double s = 1 - t[i];
      B.row(i) << s * s * s, 3 * s * s * t[i], 3 * s * t[i] * t[i], t[i] * t[i] * t[i];
    }
    c = least_squares(B, p.transpose()).transpose();
    for (int i = 0; i < n; ++i) {  // one Newton step towards the closest parameter
      const double s = 1 - t[i];
      const Vector3d q = c * B.row(i).transpose();
      const Vector3d v = 3 * s * s * (c.col(1) - c.col(0)) + 6 * s * t[i] * (c.col(2) - c.col(1)) +
                         3 * t[i] * t[i] * (c.col(3) - c.col(2));
      const double step = v.squaredNorm() > 0 ? v.dot(p.col(i) - q) / v.squaredNorm() : 0;
      const double next = std::clamp(t[i] + step, 0.0, 1.0);
      out.distance[i] = (p.col(i) - q - (next - t[i]) * v).norm();  // from the tangent there
      t[i] = next;
    }
  }
  out.begin = c.col(0), out.end = c.col(3);
  out.handles = {c.col(1), c.col(2)};
  return out;
}

RunFit elliptic_arc_through(const Matrix3Xd& p, double closing) {
  RunFit out;
  if (p.cols() < 10) return out;
  const EllipseRun fit = ellipse_along(p);
  const double gap = 2 * M_PI - fit.sweep();
  if (!fit.ok || gap < -0.2) return out;
  out.distance = fit.distance;
  if (gap < 0.2 || gap * fit.p.norm() < closing) {
    out.kind = StrokeKind::kEllipse;
    out.handles = {fit.centre, fit.p, fit.q};
    return out;
  }
  if (fit.sweep() > kMostEllipseSweep) return {};
  const ControlPoints c =
      elliptic_arc(fit.centre, fit.p, fit.q, fit.angle[0], fit.angle[fit.angle.size() - 1]);
  out.kind = StrokeKind::kEllipticArc;
  out.begin = c.p[0], out.end = c.p[3];
  out.handles = {c.p[1], c.p[2]};
  return out;
}

RunFit ellipse_through(const Matrix3Xd& p) {
  RunFit out;
  if (p.cols() < 8) return out;
  const EllipseFit fit = fit_ellipse(p);
  if (!fit.success) return out;
  const Vector3d normal = fit.u.cross(fit.v).normalized();
  if (std::abs(sweep_about(p, fit.centre, normal)) < 5) return out;
  out.kind = StrokeKind::kEllipse;
  out.handles = {fit.centre, fit.u, fit.v};
  out.distance.resize(p.cols());
  for (int i = 0; i < p.cols(); ++i)
    out.distance[i] = closest_on_curve(out.kind, out.handles.data(), p.col(i)).distance;
  return out;
}

}  // namespace sketchsplat
