// SPDX-License-Identifier: MIT
#include "topology/core/plain_curve.h"

#include <algorithm>
#include <cmath>

#include "sketches/curve/conic.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

Vector3d unit_or_zero(const Vector3d& v) {
  const double n = v.stableNorm();
  return n > 0 && std::isfinite(n) ? Vector3d(v / n) : Vector3d(Vector3d::Zero());
}

double line_parameter(const Vector3d& a, const Vector3d& b, const Vector3d& q) {
  const double l2 = (b - a).squaredNorm();
  return l2 > 0 ? std::clamp((q - a).dot(b - a) / l2, 0.0, 1.0) : 0.0;
}

double arc_parameter(const PlainCurve& c, const Vector3d& q) {
  const ArcFrame<double> f = arc_frame<double>(c.p[0], c.p[1], c.p[2]);
  if (f.straight) return line_parameter(c.p[0], c.p[2], q);
  const Vector3d centre = f.middle + f.up * (f.sagitta - f.radius);
  const double psi = std::atan2((q - centre).dot(f.along), (q - centre).dot(f.up));
  return std::clamp(0.5 * (psi / f.half_angle + 1), 0.0, 1.0);
}

double circle_parameter(const PlainCurve& c, const Vector3d& q) {
  Vector3d x, y;
  frame_of<double>(c.p[1].normalized(), &x, &y);
  const double a = std::atan2((q - c.p[0]).dot(y), (q - c.p[0]).dot(x));
  return a < 0 ? a / (2 * M_PI) + 1 : a / (2 * M_PI);
}

double searched_parameter(const PlainCurve& c, const CurveSamples& samples, const Vector3d& q) {
  int best = 0;
  (samples.position.colwise() - q).colwise().squaredNorm().minCoeff(&best);
  const double n = double(samples.position.cols() - 1), t0 = best / n;
  double t = t0;
  for (int it = 0; it < 6; ++it) {
    Vector3d p, d;
    evaluate_curve<double>(c.kind, c.p.data(), t, &p, &d);
    const double d2 = d.squaredNorm();
    if (!(d2 > 0)) break;
    t += (q - p).dot(d) / d2;
    t = std::clamp(t, t0 - 1 / n, t0 + 1 / n);
    t = c.closed() ? t - std::floor(t) : std::clamp(t, 0.0, 1.0);
    if (c.closed() && std::abs(t - t0) > 0.5) break;  // crossed the seam: good enough there
  }
  return t;
}

}  // namespace

PlainCurve plain_curve(const Sketch& sketch, int stroke) {
  PlainCurve curve;
  curve.kind = sketch.strokes[stroke].kind;
  const ControlPoints c = control_points(sketch, stroke);
  std::copy_n(c.p.begin(), c.count, curve.p.begin());
  return curve;
}

bool is_sound(const PlainCurve& curve) {
  for (int k = 0; k < curve.size(); ++k)
    if (!curve.p[k].allFinite()) return false;
  if (curve.closed()) return curve.p[1].squaredNorm() > 0;
  if (curve.kind != StrokeKind::kBezier) return (curve.end() - curve.begin()).squaredNorm() > 0;
  double extent = 0;
  for (int k = 1; k < 4; ++k) extent += (curve.p[k] - curve.p[0]).squaredNorm();
  return extent > 0;
}

CurveSamples sample_curve(const PlainCurve& curve, int pieces) {
  CurveSamples s;
  s.position.resize(3, pieces + 1);
  s.tangent.resize(3, pieces + 1);
  s.weight.resize(pieces + 1);
  for (int k = 0; k <= pieces; ++k) {
    Vector3d p, d;
    evaluate_curve<double>(curve.kind, curve.p.data(), double(k) / pieces, &p, &d);
    s.position.col(k) = p;
    s.tangent.col(k) = unit_or_zero(d);
    s.weight[k] = d.norm() / pieces * (k == 0 || k == pieces ? 0.5 : 1.0);
  }
  s.length = s.weight.sum();
  s.low = s.position.rowwise().minCoeff();
  s.high = s.position.rowwise().maxCoeff();
  return s;
}

Closest closest_point(const PlainCurve& curve, const CurveSamples& samples, const Vector3d& q) {
  Closest c;
  switch (curve.kind) {
    case StrokeKind::kLine:
      c.t = line_parameter(curve.p[0], curve.p[1], q);
      break;
    case StrokeKind::kArc:
      c.t = arc_parameter(curve, q);
      break;
    case StrokeKind::kCircle:
      c.t = circle_parameter(curve, q);
      break;
    default:
      c.t = searched_parameter(curve, samples, q);
  }
  Vector3d d;
  evaluate_curve<double>(curve.kind, curve.p.data(), c.t, &c.position, &d);
  // An arc's clamped angle may name the farther of its two ends.
  if (curve.kind == StrokeKind::kArc && (c.t == 0 || c.t == 1)) {
    const bool end = (q - curve.end()).squaredNorm() < (q - curve.begin()).squaredNorm();
    c.t = end ? 1 : 0;
    evaluate_curve<double>(curve.kind, curve.p.data(), c.t, &c.position, &d);
  }
  c.tangent = unit_or_zero(d);
  c.distance = (c.position - q).norm();
  return c;
}

double max_distance(const PlainCurve& curve, const Eigen::Matrix3Xd& points) {
  const CurveSamples samples = sample_curve(curve);
  double worst = 0;
  for (int k = 0; k < points.cols(); ++k) {
    const double d = closest_point(curve, samples, points.col(k)).distance;
    if (!(d <= worst)) worst = d;  // keeps a NaN
  }
  return worst;
}

Vector3d outward_tangent(const PlainCurve& curve, bool at_end) {
  Vector3d p, d, q;
  evaluate_curve<double>(curve.kind, curve.p.data(), at_end ? 1 : 0, &p, &d);
  // A cubic whose first two control points coincide stands still there: look a little inside.
  double extent = 0;
  for (int k = 1; k < curve.size(); ++k)
    extent = std::max(extent, (curve.p[k] - curve.p[0]).norm());
  if (!(d.norm() > 1e-6 * extent)) {
    evaluate_curve<double>(curve.kind, curve.p.data(), at_end ? 0.95 : 0.05, &q, &d);
    return unit_or_zero(p - q);
  }
  return unit_or_zero(at_end ? d : Vector3d(-d));
}

PlainCurve move_ends(const PlainCurve& curve, const Vector3d& begin, const Vector3d& end) {
  PlainCurve out = curve;
  const Vector3d d0 = begin - curve.begin(), d1 = end - curve.end();
  if (curve.kind == StrokeKind::kBezier) {
    out.p[0] = begin;
    out.p[1] += (2 * d0 + d1) / 3;
    out.p[2] += (d0 + 2 * d1) / 3;
    out.p[3] = end;
    return out;
  }
  out.p[0] = begin;
  out.p[curve.size() - 1] = end;
  if (curve.kind == StrokeKind::kEllipticArc) {
    ControlPoints c;
    c.p = curve.p, c.count = 4;
    out.p = elliptic_arc_between(c, begin, end).p;
  }
  if (curve.kind != StrokeKind::kArc) return out;
  // The new apex is where the old circle crosses the plane half way between the new ends.
  out.p[1] = curve.p[1] + (d0 + d1) / 2;
  const ArcFrame<double> f = arc_frame<double>(curve.p[0], curve.p[1], curve.p[2]);
  const Vector3d chord = unit_or_zero(end - begin), middle = (begin + end) / 2;
  const Vector3d centre = f.middle + f.up * (f.sagitta - f.radius);
  const double a = f.radius * f.up.dot(chord), b = f.radius * f.along.dot(chord);
  const double size = std::hypot(a, b), rhs = (middle - centre).dot(chord);
  if (f.straight || !(std::abs(rhs) < size)) return out;
  const double phi = std::atan2(b, a), delta = std::acos(rhs / size);
  const double psi0 = std::remainder(phi - delta, 2 * M_PI);
  const double psi1 = std::remainder(phi + delta, 2 * M_PI);
  const double psi = std::abs(psi0) < std::abs(psi1) ? psi0 : psi1;
  if (!(std::abs(psi) < f.half_angle)) return out;
  const double half = std::sin(psi / 2);  // as in evaluate_curve: no cancellation at large radii
  out.p[1] = f.middle + f.up * (f.sagitta - 2 * f.radius * half * half) +
             f.along * (f.radius * std::sin(psi));
  return out;
}

PlainCurve backwards(const PlainCurve& curve) {
  PlainCurve out = curve;
  std::reverse(out.p.begin(), out.p.begin() + out.size());
  if (curve.kind == StrokeKind::kEllipticArc) std::swap(out.p[1], out.p[2]);
  return out;
}

PlainCurve circle_of_arc(const PlainCurve& arc) {
  const ArcFrame<double> f = arc_frame<double>(arc.p[0], arc.p[1], arc.p[2]);
  PlainCurve c;
  c.kind = StrokeKind::kCircle;
  c.p[0] = f.middle + f.up * (f.sagitta - f.radius);
  c.p[1] = f.up.cross(f.along).normalized() * f.radius;
  return c;
}

}  // namespace sketchsplat
