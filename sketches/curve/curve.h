// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "sketches/graph/sketch.h"

namespace sketchsplat {

template <typename T>
using Vec3 = Eigen::Matrix<T, 3, 1>;

/// Two unit vectors that complete a unit normal to a right-handed frame. Smooth in the normal but
/// for a jump on a cone of 14 deg about an oblique direction, away from the normals that parts
/// have: a jump at a world axis would make the samples of an axis-aligned circle leap under a small
/// turn.
template <typename T>
void frame_of(const Vec3<T>& normal, Vec3<T>* x, Vec3<T>* y) {
  using std::abs;
  Vec3<T> reference(T(2.0 / 7), T(3.0 / 7), T(6.0 / 7));
  if (abs(normal.dot(reference)) > T(0.97))
    reference = Vec3<T>(T(6.0 / 7), T(2.0 / 7), T(-3.0 / 7));
  *x = (reference - normal * normal.dot(reference)).normalized();
  *y = normal.cross(*x);
}

/// Centre-free description of a circular arc by its chord and sagitta (exact up to 360 deg):
///   radius = (a^2 + h^2) / (2 h), half angle = 2 atan2(h, a), a = half chord, h = sagitta.
template <typename T>
struct ArcFrame {
  Vec3<T> middle, along, up;  ///< middle of the chord; unit along the chord; unit towards the apex
  T half_chord, sagitta, radius, half_angle;
  bool straight;  ///< sagitta below 1e-9 of the chord: radius means nothing
};
template <typename T>
ArcFrame<T> arc_frame(const Vec3<T>& begin, const Vec3<T>& apex, const Vec3<T>& end) {
  using std::atan2;
  using std::sqrt;
  ArcFrame<T> f;
  f.middle = (begin + end) * T(0.5);
  const Vec3<T> chord = end - begin;
  const T length = sqrt(chord.squaredNorm() + T(1e-300));
  f.along = chord / length;
  f.half_chord = length * T(0.5);
  Vec3<T> rise = apex - f.middle;
  rise -= f.along * f.along.dot(rise);
  const T rise2 = rise.squaredNorm();
  f.straight = !(rise2 > T(1e-18) * f.half_chord * f.half_chord);
  if (f.straight) {
    f.up = Vec3<T>::Zero();
    f.sagitta = f.radius = f.half_angle = T(0);
    return f;
  }
  f.sagitta = sqrt(rise2);
  f.up = rise / f.sagitta;
  f.radius = (f.half_chord * f.half_chord + rise2) / (T(2) * f.sagitta);
  f.half_angle = T(2) * atan2(f.sagitta, f.half_chord);
  return f;
}

/// Arc of an ellipse without its centre. With M the middle of the chord, H = (end - begin) / 2 and
/// rise R = apex - M (H and R are conjugate directions), psi in [-a, a]:
///   X(psi) = M + R (cos psi - cos a) / (1 - cos a) + H sin psi / sin a
/// runs through begin, apex and end whatever a is. The middle of X(a/2) and X(-a/2) is M + g R with
///   tan^2(a/4) = 3 - 4 g: g = 1/2 is a full turn, 3/4 a parabola,
/// and the quarter point tells g = (quarter - M).R / R.R. So the curve moves about as far as any of
/// its control points, and flat arcs are no worse than round ones. Ten of the twelve coordinates
/// count: what of the quarter point is square to R does not. Any will do: near its bounds and
/// beyond, tan^2(a/4) is bent into (0, 1).
template <typename T>
struct EllipticFrame {
  Vec3<T> middle, half_chord, rise;
  T half_angle;   ///< a, in (0, pi) rad
  bool straight;  ///< rise below 1e-9 of the chord: half_angle means nothing
};
/// Between these tan^2(a/4) is 3 - 4 g itself: turns of 32 to 348 deg.
constexpr double kLeastTan2 = 0.005, kMostTan2 = 0.9;
template <typename T>
EllipticFrame<T> elliptic_frame(const Vec3<T>& begin, const Vec3<T>& apex, const Vec3<T>& quarter,
                                const Vec3<T>& end) {
  using std::atan;
  using std::exp;
  using std::sqrt;
  EllipticFrame<T> f;
  f.middle = (begin + end) * T(0.5);
  f.half_chord = (end - begin) * T(0.5);
  f.rise = apex - f.middle;
  f.half_angle = T(0);
  const T rise2 = f.rise.squaredNorm();
  f.straight = !(rise2 > T(1e-18) * f.half_chord.squaredNorm()) || !(rise2 > T(1e-290));
  if (f.straight) return f;
  T tan2 = T(3) - T(4) * (quarter - f.middle).dot(f.rise) / rise2;
  if (tan2 < T(kLeastTan2)) {
    const T past = (T(kLeastTan2) - tan2) / T(kLeastTan2);
    tan2 = T(kLeastTan2) * exp(-(past < T(12) ? past : T(12)));
  } else if (tan2 > T(kMostTan2)) {
    const T past = (tan2 - T(kMostTan2)) / T(1 - kMostTan2);
    tan2 = T(1) - T(1 - kMostTan2) * exp(-(past < T(4) ? past : T(4)));
  }
  f.half_angle = T(4) * atan(sqrt(tan2));
  return f;
}

/// Position and derivative by t in [0, 1] of a curve with these control points (order: StrokeKind).
/// Degenerate controls give finite values: a straight arc is a line, a zero axis is a point.
template <typename T>
void evaluate_curve(StrokeKind kind, const Vec3<T>* c, double t, Vec3<T>* position,
                    Vec3<T>* derivative) {
  using std::cos;
  using std::sin;
  using std::sqrt;
  switch (kind) {
    case StrokeKind::kLine:
      *position = c[0] * T(1 - t) + c[1] * T(t);
      *derivative = c[1] - c[0];
      return;
    case StrokeKind::kBezier: {
      const double s = 1 - t;
      *position = c[0] * T(s * s * s) + c[1] * T(3 * s * s * t) + c[2] * T(3 * s * t * t) +
                  c[3] * T(t * t * t);
      *derivative = (c[1] - c[0]) * T(3 * s * s) + (c[2] - c[1]) * T(6 * s * t) +
                    (c[3] - c[2]) * T(3 * t * t);
      return;
    }
    case StrokeKind::kArc: {
      const ArcFrame<T> f = arc_frame<T>(c[0], c[1], c[2]);
      if (f.straight) {
        // Keeps the derivative by the apex alive: to first order the arc is a parabola.
        const Vec3<T> rise = c[1] - f.middle - f.along * f.along.dot(c[1] - f.middle);
        *position = c[0] * T(1 - t) + c[2] * T(t) + rise * T(4 * t * (1 - t));
        *derivative = c[2] - c[0] + rise * T(4 - 8 * t);
        return;
      }
      const T psi = T(2 * t - 1) * f.half_angle;
      const T half = sin(psi * T(0.5));
      *position = f.middle + f.up * (f.sagitta - T(2) * f.radius * half * half) +
                  f.along * (f.radius * sin(psi));
      *derivative = (f.along * cos(psi) - f.up * sin(psi)) * (f.radius * T(2) * f.half_angle);
      return;
    }
    case StrokeKind::kCircle: {
      const T r2 = c[1].squaredNorm();
      if (!(r2 > T(0))) {
        *position = c[0];
        *derivative = Vec3<T>::Zero();
        return;
      }
      const T r = sqrt(r2);
      Vec3<T> x, y;
      frame_of<T>(c[1] / r, &x, &y);
      const double a = 2 * M_PI * t;
      *position = c[0] + (x * T(std::cos(a)) + y * T(std::sin(a))) * r;
      *derivative = (y * T(std::cos(a)) - x * T(std::sin(a))) * (r * T(2 * M_PI));
      return;
    }
    case StrokeKind::kEllipse: {
      const double a = 2 * M_PI * t;
      *position = c[0] + c[1] * T(std::cos(a)) + c[2] * T(std::sin(a));
      *derivative = (c[2] * T(std::cos(a)) - c[1] * T(std::sin(a))) * T(2 * M_PI);
      return;
    }
    case StrokeKind::kEllipticArc: {
      const EllipticFrame<T> f = elliptic_frame<T>(c[0], c[1], c[2], c[3]);
      if (f.straight) {
        *position = c[0] * T(1 - t) + c[3] * T(t) + f.rise * T(4 * t * (1 - t));
        *derivative = c[3] - c[0] + f.rise * T(4 - 8 * t);
        return;
      }
      const T psi = T(2 * t - 1) * f.half_angle, half = sin(f.half_angle * T(0.5));
      const T rise = sin(f.half_angle * T(1 - t)) * sin(f.half_angle * T(t)) / (half * half);
      const T sine = sin(f.half_angle);
      *position = f.middle + f.rise * rise + f.half_chord * (sin(psi) / sine);
      *derivative =
          (f.half_chord * (cos(psi) / sine) - f.rise * (sin(psi) / (T(2) * half * half))) *
          (T(2) * f.half_angle);
      return;
    }
  }
}

/// The quarter point of an elliptic arc that turns by twice this angle [rad] (kept within 2e-3 and
/// 6.2), on the line from the middle of the chord to the apex.
Eigen::Vector3d elliptic_quarter(const Eigen::Vector3d& begin, const Eigen::Vector3d& apex,
                                 const Eigen::Vector3d& end, double half_angle);

/// Arc length of a stroke, to about 1e-9 of it.
double stroke_length(const Sketch& sketch, int stroke);

/// Point and derivative of a stroke at t in [0, 1].
void evaluate_stroke(const Sketch& sketch, int stroke, double t, Eigen::Vector3d* position,
                     Eigen::Vector3d* derivative);
/// Unit tangent of an open stroke in a node that it ends in, into the stroke; zero where the curve
/// stands still.
Eigen::Vector3d tangent_out(const Sketch& sketch, int stroke, int node);

/// The piece of an open curve between two parameters (which may lie outside [0, 1]: lines, arcs and
/// cubics go on beyond their ends), as control points of the same kind.
ControlPoints subcurve(StrokeKind kind, const ControlPoints& curve, double t0, double t1);

/// Curve parameters at which these fractions (in [0, 1]) of the arc length are passed.
std::vector<double> arc_length_parameters(const Sketch& sketch, int stroke,
                                          const std::vector<double>& fractions);

/// Points of a stroke, uniform in arc length, both ends included:
/// 3 x (max(1, ceil(length / spacing)) + 1).
Eigen::Matrix3Xd sample_stroke(const Sketch& sketch, int stroke, double spacing);

/// Longest side of the box along the axes around all strokes, to about 1 %; 0 if there is none.
double largest_extent(const Sketch& sketch);

}  // namespace sketchsplat
