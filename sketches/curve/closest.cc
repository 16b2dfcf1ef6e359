// SPDX-License-Identifier: MIT
#include "sketches/curve/closest.h"

#include <algorithm>
#include <cmath>

#include "sketches/curve/conic.h"
#include "sketches/curve/curve.h"

namespace sketchsplat {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double closest_on_segment(const Vector3d& a, const Vector3d& b, const Vector3d& p) {
  const double length2 = (b - a).squaredNorm();
  return length2 > 0 ? std::clamp((p - a).dot(b - a) / length2, 0.0, 1.0) : 0.0;
}

double closest_on_arc(const Vector3d* c, const Vector3d& p) {
  const ArcFrame<double> f = arc_frame<double>(c[0], c[1], c[2]);
  if (f.straight) return closest_on_segment(c[0], c[2], p);
  // From the middle of the chord, not from the centre, which may be far away.
  const Vector3d w = p - f.middle;
  const double psi = std::atan2(w.dot(f.along), w.dot(f.up) - f.sagitta + f.radius);
  if (std::abs(psi) <= f.half_angle) return 0.5 * (psi / f.half_angle + 1);
  return (p - c[0]).squaredNorm() <= (p - c[2]).squaredNorm() ? 0 : 1;
}

double turn(double angle) {  // to [0, 1)
  const double t = angle / (2 * M_PI);
  return std::min(t - std::floor(t), 1 - 1e-16);
}

double closest_on_circle(const Vector3d* c, const Vector3d& p) {
  const double r = c[1].norm();
  if (!(r > 0)) return 0;
  Vector3d x, y;
  frame_of<double>(c[1] / r, &x, &y);
  return turn(std::atan2((p - c[0]).dot(y), (p - c[0]).dot(x)));
}

// Cosine and sine of the eccentric angle of the nearest point, for semi-axes a >= b > 0 and a point
// in the first quadrant. F falls monotonically in its interval, so bisection cannot miss the root.
Vector2d closest_in_quadrant(double a, double b, const Vector2d& p) {
  if (p.y() <= 0) {
    const double denominator = a * a - b * b;
    if (a * p.x() >= denominator) return {1, 0};
    const double x = a * p.x() / denominator;
    return {x, std::sqrt(1 - x * x)};
  }
  if (p.x() <= 0) return {0, 1};
  const double ratio = (a / b) * (a / b), z0 = p.x() / a, z1 = p.y() / b;
  double low = z1 - 1, high = std::hypot(ratio * z0, z1) - 1;
  for (int i = 0; i < 200; ++i) {
    const double s = 0.5 * (low + high);
    if (s == low || s == high) break;
    const double f0 = ratio * z0 / (s + ratio), f1 = z1 / (s + 1);
    (f0 * f0 + f1 * f1 > 1 ? low : high) = s;
  }
  const double s = 0.5 * (low + high);
  return Vector2d(ratio * z0 / (s + ratio), z1 / (s + 1)).normalized();
}

double closest_on_ellipse(const Vector3d* c, const Vector3d& p) {
  const EllipseAxes axes = principal_axes(c[1], c[2]);
  const double a = axes.major.norm(), b = axes.minor.norm();
  if (!(a > 0)) return 0;
  const Vector3d w = p - c[0];
  const double x = w.dot(axes.major) / a;
  double angle;
  if (b > 1e-12 * a) {
    const double y = w.dot(axes.minor) / b;
    const Vector2d q = closest_in_quadrant(a, b, {std::abs(x), std::abs(y)});
    angle = std::atan2(std::copysign(q.y(), y), std::copysign(q.x(), x));
  } else {  // a doubled segment
    angle = std::acos(std::clamp(x / a, -1.0, 1.0));
  }
  // From the angle about the principal axes to that about u and v (see principal_axes).
  return turn(angle +
              0.5 * std::atan2(2 * c[1].dot(c[2]), c[1].squaredNorm() - c[2].squaredNorm()));
}

// Half the derivative of the squared distance, and its own derivative.
double slope(StrokeKind kind, const Vector3d* c, const Vector3d& p, double t, double* second) {
  Vector3d x, d, dd;
  evaluate_curve<double>(kind, c, t, &x, &d);
  if (kind == StrokeKind::kBezier) {
    dd = 6 * ((1 - t) * (c[2] - 2 * c[1] + c[0]) + t * (c[3] - 2 * c[2] + c[1]));
  } else {
    ControlPoints control;
    for (int k = 0; k < 4; ++k) control.p[k] = c[k];
    const EllipticArcParameters e = elliptic_arc_parameters(control);
    const double turn = 2 * e.half_angle;
    dd = e.straight ? Vector3d(-8 * (c[1] - (c[0] + c[3]) / 2))
                    : Vector3d(turn * turn * (e.centre - x));
  }
  *second = d.squaredNorm() + (x - p).dot(dd);
  return (x - p).dot(d);
}

// Root of the slope in a bracket around a sampled minimum: Newton, or halving where Newton leaves
// it.
double refine_minimum(StrokeKind kind, const Vector3d* c, const Vector3d& p, double low,
                      double high, double t) {
  for (int i = 0; i < 60 && high - low > 1e-15; ++i) {
    double second;
    const double g = slope(kind, c, p, t, &second);
    if (g == 0) return t;
    (g < 0 ? low : high) = t;
    const double newton = t - g / second;
    const double next = second > 0 && newton > low && newton < high ? newton : 0.5 * (low + high);
    if (std::abs(next - t) < 1e-15) return next;
    t = next;
  }
  return t;
}

// Of a cubic or an elliptic arc.
double closest_by_search(StrokeKind kind, const Vector3d* c, const Vector3d& p) {
  constexpr int kSamples = 32;
  double d2[kSamples + 1];
  const auto squared_distance = [&](double t) {
    Vector3d x, d;
    evaluate_curve<double>(kind, c, t, &x, &d);
    return (x - p).squaredNorm();
  };
  for (int i = 0; i <= kSamples; ++i) d2[i] = squared_distance(double(i) / kSamples);
  double best = d2[0] <= d2[kSamples] ? 0 : 1, best_d2 = std::min(d2[0], d2[kSamples]);
  for (int i = 0; i <= kSamples; ++i) {
    if ((i > 0 && d2[i - 1] < d2[i]) || (i < kSamples && d2[i + 1] < d2[i])) continue;
    const double low = std::max(0, i - 1) / double(kSamples);
    const double high = std::min(kSamples, i + 1) / double(kSamples);
    const double t = refine_minimum(kind, c, p, low, high, double(i) / kSamples);
    const double value = squared_distance(t);
    if (value < best_d2) {
      best = t;
      best_d2 = value;
    }
  }
  return best;
}

double closest_parameter(StrokeKind kind, const Vector3d* c, const Vector3d& p) {
  switch (kind) {
    case StrokeKind::kLine:
      return closest_on_segment(c[0], c[1], p);
    case StrokeKind::kArc:
      return closest_on_arc(c, p);
    case StrokeKind::kCircle:
      return closest_on_circle(c, p);
    case StrokeKind::kEllipse:
      return closest_on_ellipse(c, p);
    case StrokeKind::kBezier:
    case StrokeKind::kEllipticArc:
      break;
  }
  return closest_by_search(kind, c, p);
}

}  // namespace

ClosestPoint closest_on_curve(StrokeKind kind, const Vector3d* control, const Vector3d& point) {
  ClosestPoint out;
  out.t = closest_parameter(kind, control, point);
  Vector3d derivative;
  evaluate_curve<double>(kind, control, out.t, &out.position, &derivative);
  out.distance = (point - out.position).norm();
  return out;
}

ClosestPoint distance_to_stroke(const Sketch& sketch, int stroke, const Vector3d& point) {
  const ControlPoints c = control_points(sketch, stroke);
  return closest_on_curve(sketch.strokes[stroke].kind, c.p.data(), point);
}

}  // namespace sketchsplat
