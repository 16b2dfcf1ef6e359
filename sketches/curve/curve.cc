// SPDX-License-Identifier: MIT
#include "sketches/curve/curve.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

namespace sketchsplat {
namespace {

// Nodes and weights of Gauss-Legendre quadrature of order 5 on [-1, 1].
constexpr double kNode[5] = {0.0, -0.5384693101056831, 0.5384693101056831, -0.9061798459386640,
                             0.9061798459386640};
constexpr double kWeight[5] = {0.5688888888888889, 0.4786286704993665, 0.4786286704993665,
                               0.2369268850561891, 0.2369268850561891};

double speed(const Sketch& sketch, int stroke, double t) {
  Eigen::Vector3d p, d;
  evaluate_stroke(sketch, stroke, t, &p, &d);
  return d.norm();
}

double gauss_length(const Sketch& sketch, int stroke, double t0, double t1) {
  double sum = 0;
  for (int k = 0; k < 5; ++k)
    sum += kWeight[k] * speed(sketch, stroke, 0.5 * (t0 + t1) + 0.5 * (t1 - t0) * kNode[k]);
  return 0.5 * (t1 - t0) * sum;
}

// Halves the interval until the quadrature agrees with itself: cusps and the ends of thin ellipses.
double refine_length(const Sketch& sketch, int stroke, double t0, double t1, double whole,
                     double tolerance, int depth) {
  const double middle = 0.5 * (t0 + t1);
  const double left = gauss_length(sketch, stroke, t0, middle);
  const double right = gauss_length(sketch, stroke, middle, t1);
  if (depth == 0 || !(std::abs(left + right - whole) > tolerance)) return left + right;
  return refine_length(sketch, stroke, t0, middle, left, tolerance, depth - 1) +
         refine_length(sketch, stroke, middle, t1, right, tolerance, depth - 1);
}

double length_between(const Sketch& sketch, int stroke, double t0, double t1, double tolerance) {
  return refine_length(sketch, stroke, t0, t1, gauss_length(sketch, stroke, t0, t1), tolerance, 12);
}

// What counts as nothing in a length: 1e-11 of a coarse estimate of the whole.
double negligible_length(const Sketch& sketch, int stroke) {
  double sum = 0;
  for (int i = 0; i < 4; ++i) sum += gauss_length(sketch, stroke, 0.25 * i, 0.25 * (i + 1));
  return 1e-11 * sum;
}

bool has_constant_speed(StrokeKind kind) {
  return kind == StrokeKind::kLine || kind == StrokeKind::kArc || kind == StrokeKind::kCircle;
}

// Pieces of the table of arc lengths: few Newton steps inside one, and a turn of an ellipse has
// four.
constexpr int kPieces = 16;

}  // namespace

Eigen::Vector3d elliptic_quarter(const Eigen::Vector3d& begin, const Eigen::Vector3d& apex,
                                 const Eigen::Vector3d& end, double half_angle) {
  const double root = std::tan(std::clamp(half_angle, 1e-3, 3.1) / 4);
  double tan2 = root * root;  // what elliptic_frame bends into this
  if (tan2 < kLeastTan2) tan2 = kLeastTan2 * (1 + std::log(tan2 / kLeastTan2));
  if (tan2 > kMostTan2) tan2 = kMostTan2 - (1 - kMostTan2) * std::log((1 - tan2) / (1 - kMostTan2));
  const Eigen::Vector3d middle = (begin + end) / 2;
  return middle + (3 - tan2) / 4 * (apex - middle);
}

void evaluate_stroke(const Sketch& sketch, int stroke, double t, Eigen::Vector3d* position,
                     Eigen::Vector3d* derivative) {
  const ControlPoints c = control_points(sketch, stroke);
  evaluate_curve<double>(sketch.strokes[stroke].kind, c.p.data(), t, position, derivative);
}
Eigen::Vector3d tangent_out(const Sketch& sketch, int stroke, int node) {
  Eigen::Vector3d p, d;
  const bool at_begin = sketch.strokes[stroke].begin == node;
  evaluate_stroke(sketch, stroke, at_begin ? 0 : 1, &p, &d);
  return (at_begin ? d : Eigen::Vector3d(-d)).stableNormalized();
}

double stroke_length(const Sketch& sketch, int stroke) {
  if (has_constant_speed(sketch.strokes[stroke].kind)) return speed(sketch, stroke, 0.5);
  const double tolerance = negligible_length(sketch, stroke);
  double sum = 0;
  for (int i = 0; i < 4; ++i)
    sum += length_between(sketch, stroke, 0.25 * i, 0.25 * (i + 1), tolerance);
  return sum;
}

ControlPoints subcurve(StrokeKind kind, const ControlPoints& curve, double t0, double t1) {
  ControlPoints out = curve;
  Eigen::Vector3d d;
  const auto at = [&](double t) {
    Eigen::Vector3d p;
    evaluate_curve<double>(kind, curve.p.data(), t, &p, &d);
    return p;
  };
  if (is_closed(kind)) return out;
  out.p[0] = at(t0);
  out.p[curve.count - 1] = at(t1);
  if (kind == StrokeKind::kArc) out.p[1] = at(0.5 * (t0 + t1));
  if (kind == StrokeKind::kEllipticArc) {
    out.p[1] = at(0.5 * (t0 + t1));
    const EllipticFrame<double> f =
        elliptic_frame<double>(curve.p[0], curve.p[1], curve.p[2], curve.p[3]);
    out.p[2] = elliptic_quarter(out.p[0], out.p[1], out.p[3], f.half_angle * (t1 - t0));
  }
  if (kind == StrokeKind::kBezier) {  // Hermite form of the piece
    Eigen::Vector3d p;
    evaluate_curve<double>(kind, curve.p.data(), t0, &p, &d);
    out.p[1] = p + d * ((t1 - t0) / 3);
    evaluate_curve<double>(kind, curve.p.data(), t1, &p, &d);
    out.p[2] = p - d * ((t1 - t0) / 3);
  }
  return out;
}

std::vector<double> arc_length_parameters(const Sketch& sketch, int stroke,
                                          const std::vector<double>& fractions) {
  if (has_constant_speed(sketch.strokes[stroke].kind)) return fractions;
  const double tolerance = negligible_length(sketch, stroke);
  std::vector<double> cumulative(kPieces + 1, 0.0);
  for (int i = 0; i < kPieces; ++i)
    cumulative[i + 1] = cumulative[i] + length_between(sketch, stroke, double(i) / kPieces,
                                                       double(i + 1) / kPieces, tolerance);
  const double total = cumulative.back();
  std::vector<double> t;
  for (double f : fractions) {
    if (f <= 0 || f >= 1 || total <= 0) {
      t.push_back(std::clamp(f, 0.0, 1.0));
      continue;
    }
    const double target = f * total;
    const int i = std::clamp(
        int(std::upper_bound(cumulative.begin(), cumulative.end(), target) - cumulative.begin()) -
            1,
        0, kPieces - 1);
    const double t0 = double(i) / kPieces;
    double x = t0 + (target - cumulative[i]) / (cumulative[i + 1] - cumulative[i]) / kPieces;
    for (int it = 0; it < 8; ++it) {  // Newton on the arc length inside the piece
      const double v = speed(sketch, stroke, x);
      if (!(v > 1e-12 * total)) break;
      const double step =
          (cumulative[i] + length_between(sketch, stroke, t0, x, tolerance) - target) / v;
      x = std::clamp(x - step, t0, t0 + 1.0 / kPieces);
      if (std::abs(step) < 1e-12) break;
    }
    t.push_back(x);
  }
  return t;
}

Eigen::Matrix3Xd sample_stroke(const Sketch& sketch, int stroke, double spacing) {
  const int n = std::max(1, int(std::ceil(stroke_length(sketch, stroke) / spacing)));
  std::vector<double> fractions(n + 1);
  for (int i = 0; i <= n; ++i) fractions[i] = double(i) / n;
  const std::vector<double> t = arc_length_parameters(sketch, stroke, fractions);
  Eigen::Matrix3Xd out(3, n + 1);
  Eigen::Vector3d p, d;
  for (int i = 0; i <= n; ++i) {
    evaluate_stroke(sketch, stroke, t[i], &p, &d);
    out.col(i) = p;
  }
  return out;
}

double largest_extent(const Sketch& sketch) {
  constexpr int kSteps = 32;
  Eigen::AlignedBox3d box;
  Eigen::Vector3d p, d;
  for (int s = 0; s < sketch.size(); ++s)
    for (int i = 0; i <= kSteps; ++i) {
      evaluate_stroke(sketch, s, double(i) / kSteps, &p, &d);
      box.extend(p);
    }
  return box.isEmpty() ? 0.0 : box.sizes().maxCoeff();
}

}  // namespace sketchsplat
