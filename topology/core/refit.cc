// SPDX-License-Identifier: MIT
#include "topology/core/refit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "datasets/types/dense.h"
#include "sketches/curve/conic.h"
#include "sketches/fit/ellipse_run.h"
#include "sketches/fit/fit.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

struct Principal {
  Vector3d mean;
  Vector3d value;        // ascending, variance
  Eigen::Matrix3d axis;  // columns
};

std::optional<Principal> principal(const Run& run) {
  const double total = run.weight.sum();
  if (!(total > 0)) return std::nullopt;
  Principal p;
  p.mean = run.position * run.weight / total;
  const Eigen::Matrix3Xd centred = run.position.colwise() - p.mean;
  const Eigen::Matrix3d scatter = centred * run.weight.asDiagonal() * centred.transpose() / total;
  if (!scatter.allFinite() || !(scatter.trace() > 0)) return std::nullopt;
  const auto solver = eigen_symmetric(scatter);
  p.value = solver.values;
  p.axis = solver.vectors;
  return p;
}

std::optional<PlainCurve> if_sound(const PlainCurve& c) {
  return is_sound(c) ? std::optional<PlainCurve>(c) : std::nullopt;
}

// Circle in the plane: centre and radius from weighted points (2 x n) of unit spread.
bool circle_in_plane(const Eigen::Matrix2Xd& q, const VectorXd& w, Vector3d* circle) {
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Vector3d b = Vector3d::Zero();
  for (int k = 0; k < q.cols(); ++k) {
    const Vector3d row(q(0, k), q(1, k), 1);
    a += w[k] * row * row.transpose();
    b += w[k] * row * q.col(k).squaredNorm();
  }
  const Vector3d s = solve_symmetric(a, b);
  const double r2 = s[2] + 0.25 * s.head<2>().squaredNorm();
  if (!s.allFinite() || !(r2 > 0)) return false;
  *circle = Vector3d(s[0] / 2, s[1] / 2, std::sqrt(r2));
  for (int it = 0; it < 10; ++it) {
    a.setZero();
    b.setZero();
    for (int k = 0; k < q.cols(); ++k) {
      const Eigen::Vector2d d = q.col(k) - circle->head<2>();
      const double n = d.norm();
      if (!(n > 0)) continue;
      const Vector3d row(-d.x() / n, -d.y() / n, -1);
      a += w[k] * row * row.transpose();
      b -= w[k] * row * (n - (*circle)[2]);
    }
    const Vector3d step = solve_symmetric(a, b);
    if (!step.allFinite() || !(step.norm() < (*circle)[2])) break;
    *circle += step;
    if (step.norm() < 1e-13 * (*circle)[2]) break;
  }
  return circle->allFinite() && (*circle)[2] > 0;
}

// Basis functions of the curves that are linear in their control points.
VectorXd basis(StrokeKind kind, double t) {
  const double s = 1 - t, a = 2 * M_PI * t;
  if (kind == StrokeKind::kBezier)
    return Eigen::Vector4d(s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t);
  return Vector3d(1, std::cos(a), std::sin(a));
}

bool solve_controls(const Run& points, const VectorXd& t, PlainCurve* curve) {
  const int n = curve->size();
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n), b = Eigen::MatrixXd::Zero(n, 3);
  for (int k = 0; k < t.size(); ++k) {
    const VectorXd row = basis(curve->kind, t[k]);
    a += points.weight[k] * row * row.transpose();
    b += points.weight[k] * row * points.position.col(k).transpose();
  }
  const Eigen::MatrixXd x = solve_symmetric(a, b);
  if (!x.allFinite()) return false;
  for (int k = 0; k < n; ++k) curve->p[k] = x.row(k).transpose();
  return true;
}

std::optional<PlainCurve> refit_linear(StrokeKind kind, const Run& points, VectorXd t) {
  PlainCurve curve;
  curve.kind = kind;
  const auto spread = principal(points);
  if (!spread) return std::nullopt;
  // Centred and scaled to unit spread: the normal equations stay well conditioned at any scale.
  const double scale = std::sqrt(spread->value[2]);
  Run local = points;
  local.position = (points.position.colwise() - spread->mean) / scale;
  for (int it = 0; it < 16; ++it) {
    if (kind == StrokeKind::kBezier) {
      const double low = t.minCoeff(), high = t.maxCoeff();
      if (!(high > low)) return std::nullopt;
      t = (t.array() - low) / (high - low);
    }
    if (!solve_controls(local, t, &curve)) return std::nullopt;
    for (int k = 0; k < t.size(); ++k) {
      Vector3d p, d;
      evaluate_curve<double>(kind, curve.p.data(), t[k], &p, &d);
      if (!(d.squaredNorm() > 0)) continue;
      const double step = (local.position.col(k) - p).dot(d) / d.squaredNorm();
      t[k] += std::clamp(step, -0.1, 0.1);
      if (kind == StrokeKind::kBezier) t[k] = std::clamp(t[k], 0.0, 1.0);
    }
  }
  for (int k = 0; k < curve.size(); ++k) {
    curve.p[k] *= scale;
    if (kind == StrokeKind::kBezier || k == 0) curve.p[k] += spread->mean;
  }
  return if_sound(curve);
}

struct Interval {
  double low, high;
};

// Start and end of the smallest piece of the circle that holds all intervals (angles, any branch).
Interval cover(std::vector<Interval> parts) {
  for (Interval& p : parts) {
    const double shift = std::floor(p.low / (2 * M_PI)) * 2 * M_PI;
    p.low -= shift;
    p.high -= shift;
  }
  std::sort(parts.begin(), parts.end(), [](auto& a, auto& b) { return a.low < b.low; });
  double reach = 0, widest = -1;
  Interval out{0, 2 * M_PI};
  for (const Interval& p : parts) reach = std::max(reach, p.high - 2 * M_PI);
  for (const Interval& p : parts) {
    if (p.low - reach > widest && p.low > reach) {
      widest = p.low - reach;
      out = {p.low, reach + 2 * M_PI};
    }
    reach = std::max(reach, p.high);
  }
  const double last = parts.front().low + 2 * M_PI - reach;
  if (last > widest && last > 0) out = {parts.front().low, reach};
  return out;
}

Interval turned_by(const Run& run, const Vector3d& centre, const Vector3d& x, const Vector3d& y) {
  double angle = 0, low = 0, high = 0;
  for (int k = 0; k < run.position.cols(); ++k) {
    const Vector3d q = run.position.col(k) - centre;
    const double a = std::atan2(q.dot(y), q.dot(x));
    angle = k == 0 ? a : angle + std::remainder(a - angle, 2 * M_PI);
    low = k == 0 ? a : std::min(low, angle);
    high = k == 0 ? a : std::max(high, angle);
  }
  return {low, high};
}

// Handles by linear least squares at the parameters of the nearest points: from where the cubic is,
// for a start by chord lengths (fit_bezier) hooks ends that have moved beyond the points.
PlainCurve refit_cubic_between(PlainCurve cubic, const Eigen::Matrix3Xd& points) {
  constexpr int kRounds = 2;
  for (int round = 0; round < kRounds; ++round) {
    const CurveSamples samples = sample_curve(cubic);
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    Eigen::Matrix<double, 2, 3> pull = Eigen::Matrix<double, 2, 3>::Zero();
    for (int i = 0; i < points.cols(); ++i) {
      const double t = closest_point(cubic, samples, points.col(i)).t, u = 1 - t;
      const Eigen::Vector2d basis(3 * u * u * t, 3 * u * t * t);
      const Vector3d rest = points.col(i) - u * u * u * cubic.p[0] - t * t * t * cubic.p[3];
      normal += basis * basis.transpose();
      pull += basis * rest.transpose();
    }
    // Points all over the curve make the smaller eigenvalue a twentieth of the trace.
    if (!(normal.determinant() > 1e-3 * std::pow(normal.trace(), 2))) return cubic;
    const Eigen::Matrix<double, 2, 3> handles = normal.inverse() * pull;
    cubic.p[1] = handles.row(0);
    cubic.p[2] = handles.row(1);
  }
  return cubic;
}

}  // namespace

Run joined(const std::vector<Run>& runs) {
  int n = 0;
  for (const Run& r : runs) n += int(r.weight.size());
  Run out{Eigen::Matrix3Xd(3, n), VectorXd(n)};
  n = 0;
  for (const Run& r : runs) {
    out.position.middleCols(n, r.weight.size()) = r.position;
    out.weight.segment(n, r.weight.size()) = r.weight;
    n += int(r.weight.size());
  }
  return out;
}

std::optional<PlainCurve> refit_line(const std::vector<Run>& runs) {
  const Run all = joined(runs);
  const auto p = principal(all);
  if (!p) return std::nullopt;
  const Vector3d axis = p->axis.col(2);
  const VectorXd along = (all.position.colwise() - p->mean).transpose() * axis;
  PlainCurve line;
  line.p[0] = p->mean + axis * along.minCoeff();
  line.p[1] = p->mean + axis * along.maxCoeff();
  return if_sound(line);
}

std::optional<PlainCurve> refit_circle(const Run& points) {
  const auto p = principal(points);
  if (!p || !(p->value[1] > 1e-12 * p->value[2])) return std::nullopt;
  const double scale = std::sqrt(p->value[2]);
  const Eigen::Matrix3Xd centred = (points.position.colwise() - p->mean) / scale;
  Eigen::Matrix2Xd q(2, centred.cols());
  q.row(0) = p->axis.col(2).transpose() * centred;
  q.row(1) = p->axis.col(1).transpose() * centred;
  Vector3d circle;
  if (!circle_in_plane(q, points.weight / points.weight.sum(), &circle)) return std::nullopt;
  PlainCurve c;
  c.kind = StrokeKind::kCircle;
  c.p[0] = p->mean + scale * (p->axis.col(2) * circle[0] + p->axis.col(1) * circle[1]);
  c.p[1] = p->axis.col(0) * (scale * circle[2]);
  return if_sound(c);
}

std::optional<PlainCurve> refit_arc(const std::vector<Run>& runs, double closing) {
  const auto circle = refit_circle(joined(runs));
  if (!circle) return std::nullopt;
  const double radius = circle->p[1].norm();
  const Vector3d centre = circle->p[0];
  Vector3d x, y;
  frame_of<double>(circle->p[1] / radius, &x, &y);
  std::vector<Interval> parts;
  for (const Run& run : runs) {
    parts.push_back(turned_by(run, centre, x, y));
    if (!(parts.back().high - parts.back().low < 2 * M_PI)) return std::nullopt;
  }
  const Interval whole = cover(parts);
  if ((2 * M_PI - (whole.high - whole.low)) * radius <= closing) return circle;
  const auto at = [&](double a) {
    return Vector3d(centre + radius * (x * std::cos(a) + y * std::sin(a)));
  };
  PlainCurve arc;
  arc.kind = StrokeKind::kArc;
  arc.p = {at(whole.low), at((whole.low + whole.high) / 2), at(whole.high), Vector3d::Zero()};
  return if_sound(arc);
}

PlainCurve refit_between(const PlainCurve& curve, const Eigen::Matrix3Xd& points) {
  PlainCurve out = curve;
  if (curve.kind == StrokeKind::kArc && points.cols() > 0) {
    const ArcFit fit = fit_arc(points, curve.begin(), curve.end());
    if (fit.success) out.p[1] = fit.apex;
  } else if (curve.kind == StrokeKind::kBezier) {
    out = refit_cubic_between(curve, points);
  }
  return is_sound(out) ? out : curve;
}

std::optional<PlainCurve> refit_bezier(const Run& points, VectorXd t) {
  return refit_linear(StrokeKind::kBezier, points, std::move(t));
}

std::optional<PlainCurve> refit_ellipse(const Run& points, VectorXd t) {
  const auto e = refit_linear(StrokeKind::kEllipse, points, std::move(t));
  return e ? if_sound(with_principal_axes(*e)) : std::nullopt;
}

std::optional<PlainCurve> refit_elliptic_arc(const std::vector<Run>& runs, double closing) {
  const Run all = joined(runs);
  const EllipseRun fit = ellipse_through_runs(all.position, all.weight);
  if (!fit.ok) return std::nullopt;
  std::vector<Interval> parts;
  Eigen::Index first = 0;
  for (const Run& run : runs) {
    const auto angle = fit.angle.segment(first, run.weight.size());
    parts.push_back({angle.minCoeff(), angle.maxCoeff()});
    if (!(parts.back().high - parts.back().low < 2 * M_PI)) return std::nullopt;
    first += run.weight.size();
  }
  const Interval whole = cover(parts);
  const double turn = whole.high - whole.low;
  PlainCurve out;
  if ((2 * M_PI - turn) * fit.p.norm() <= closing) {
    out.kind = StrokeKind::kEllipse;
    out.p = {fit.centre, fit.p, fit.q, Vector3d::Zero()};
    return if_sound(with_principal_axes(out));
  }
  if (turn < kLeastEllipseSweep || turn > kMostEllipseSweep) return std::nullopt;
  out.kind = StrokeKind::kEllipticArc;
  out.p = elliptic_arc(fit.centre, fit.p, fit.q, whole.low, whole.high).p;
  return if_sound(out);
}

PlainCurve with_principal_axes(const PlainCurve& ellipse) {
  const EllipseAxes axes = principal_axes(ellipse.p[1], ellipse.p[2]);
  PlainCurve out = ellipse;
  out.p[1] = axes.major;
  out.p[2] = axes.minor;
  return out;
}

}  // namespace sketchsplat
