// SPDX-License-Identifier: MIT
#include "sketches/fit/fit.h"

#include <ceres/rotation.h>
#include <ceres/tiny_solver.h>
#include <ceres/tiny_solver_autodiff_function.h>

#include <Eigen/Geometry>
#include <cmath>

#include "datasets/types/dense.h"
#include "sketches/fit/refine.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// A circle by a point on it, the tangent, the direction to the centre and the plane's normal there,
// and the curvature: all of these stay of order 1 while the centre runs off to infinity.
struct CurvedFrame {
  Vector3d point;
  Eigen::Matrix3d axes;  // columns: tangent, inward, normal
  double curvature = 0;
  // Point at this angle from `point`.
  Vector3d at(double angle) const {
    const double half = std::sin(0.5 * angle);
    return point + (axes.col(0) * std::sin(angle) + axes.col(1) * (2 * half * half)) / curvature;
  }
};

// Offset from the circle in its plane, stable for any curvature k and local coordinates x (along
// the tangent) and y (inward): with A = 2 y - k (x^2 + y^2), it is A / (1 + sqrt(1 - k A)).
template <typename T>
T offset_from_circle(const T& x, const T& y, const T& k) {
  using std::sqrt;
  const T towards = k * y - T(1);
  return (T(2) * y - k * (x * x + y * y)) /
         (T(1) + sqrt(k * k * x * x + towards * towards + T(1e-24)));
}

// Residuals of points from the circle of a frame that is shifted and turned a little.
struct CircleResiduals {
  Matrix3Xd local;  // points in the frame where the search starts
  int NumResiduals() const { return 2 * int(local.cols()); }
  template <typename T>
  bool operator()(const T* x, T* residuals) const {  // inward, normal shift; rotation; curvature
    const T turn[3] = {-x[2], -x[3], -x[4]};
    for (int i = 0; i < local.cols(); ++i) {
      const T p[3] = {T(local(0, i)), local(1, i) - x[0], local(2, i) - x[1]};
      T q[3];
      ceres::AngleAxisRotatePoint(turn, p, q);
      residuals[2 * i] = offset_from_circle<T>(q[0], q[1], x[5]);
      residuals[2 * i + 1] = q[2];
    }
    return true;
  }
};

// Taubin's fit in the plane of the points by singular values (Chernov 2010, section 5.9):
// a (x^2 + y^2) + b x + c y + d = 0, from which the frame nearest to the mean of the points.
bool start_circle(const Matrix3Xd& points, double resolution, CurvedFrame* frame) {
  const Svd spread = svd(points.transpose());
  if (!(spread.values[1] > (1e-9 + resolution) * spread.values[0])) return false;
  const Vector3d e0 = spread.v.col(0), e1 = spread.v.col(1);
  const Eigen::VectorXd x = points.transpose() * e0, y = points.transpose() * e1;
  const Eigen::VectorXd z = x.cwiseAbs2() + y.cwiseAbs2();
  const double mean = z.mean(), weight = 2 * std::sqrt(mean);
  Eigen::MatrixX3d M(points.cols(), 3);
  M << (z.array() - mean).matrix() / weight, x, y;
  const Vector3d v = svd(M).v.col(2);
  double a = v[0] / weight, b = v[1], c = v[2], d = -a * mean;
  const double norm = std::sqrt(std::max(0.0, b * b + c * c - 4 * a * d));
  if (!(norm > 0)) return false;
  const double sign = a < 0 ? -1 / norm : 1 / norm;
  a *= sign, b *= sign, c *= sign, d *= sign;
  Eigen::Vector2d outward(b, c);
  outward = outward.norm() > 1e-9 ? outward.normalized() : Eigen::Vector2d(1, 0);
  const double distance = 2 * d / (1 + std::sqrt(std::max(0.0, 1 + 4 * a * d)));
  const Vector3d direction = e0 * outward.x() + e1 * outward.y();
  frame->point = -distance * direction;
  frame->axes.col(1) = -direction;
  frame->axes.col(2) = e0.cross(e1);
  frame->axes.col(0) = frame->axes.col(1).cross(frame->axes.col(2));
  frame->curvature = 2 * a;
  return true;
}

// Circle of normalised points; false if they tell no plane or no curvature.
bool solve_circle(const Normalised& n, CurvedFrame* frame, FitQuality* quality) {
  if (!n.usable || !start_circle(n.points, n.resolution, frame)) return false;
  CircleResiduals residuals{frame->axes.transpose() * (n.points.colwise() - frame->point)};
  using Function = ceres::TinySolverAutoDiffFunction<CircleResiduals, Eigen::Dynamic, 6>;
  Function function(residuals);
  ceres::TinySolver<Function> solver;
  solver.options.max_num_iterations = 50;
  solver.options.gradient_tolerance = 1e-15;
  solver.options.parameter_tolerance = 1e-14;
  solver.options.cost_threshold = 1e-32;
  Eigen::Matrix<double, 6, 1> x = Eigen::Matrix<double, 6, 1>::Zero();
  x[5] = frame->curvature;
  solver.Solve(function, &x);
  if (!x.allFinite()) return false;
  Eigen::VectorXd r(residuals.NumResiduals());
  residuals(x.data(), r.data());
  *quality = quality_of(
      Eigen::Map<const Eigen::Matrix2Xd>(r.data(), 2, r.size() / 2).colwise().norm().transpose());

  const Vector3d turn = x.segment<3>(2);
  const double angle = turn.norm();
  frame->point += frame->axes.col(1) * x[0] + frame->axes.col(2) * x[1];
  if (angle > 0) frame->axes = frame->axes * Eigen::AngleAxisd(angle, turn / angle);
  frame->curvature = x[5];
  if (frame->curvature < 0) {
    frame->curvature *= -1;
    frame->axes.leftCols(2) *= -1;
  }
  return quality->success && frame->curvature > 1e-8 + 100 * n.resolution;
}

void rescale(double scale, FitQuality* quality) {
  quality->rms *= scale;
  quality->max_distance *= scale;
}

}  // namespace

LineFit fit_line(const Matrix3Xd& points, const Eigen::VectorXd& weights) {
  LineFit out;
  Matrix3Xd kept = points;
  Eigen::VectorXd w = weights;
  if (w.size() == 0) {
    w = Eigen::VectorXd::Ones(points.cols());
  } else {
    if (!w.allFinite() || w.minCoeff() < 0 || w.size() != points.cols()) return out;
    int n = 0;
    for (int i = 0; i < points.cols(); ++i)
      if (weights[i] > 0) {
        kept.col(n) = points.col(i);
        w[n++] = weights[i];
      }
    kept.conservativeResize(3, n);
    w.conservativeResize(n);
  }
  const Normalised n = normalise(kept, 2);
  if (!n.usable) return out;
  w /= w.sum();
  const Vector3d mean = n.points * w;
  const Matrix3Xd centred = n.points.colwise() - mean;
  const Vector3d direction = svd(w.cwiseSqrt().asDiagonal() * centred.transpose()).v.col(0);
  const Eigen::VectorXd along = centred.transpose() * direction;
  const Eigen::VectorXd distance =
      (centred - direction * along.transpose()).colwise().norm().transpose();
  out.begin = n.restore(mean + direction * along.minCoeff());
  out.end = n.restore(mean + direction * along.maxCoeff());
  out.rms = n.scale * std::sqrt(distance.cwiseAbs2().dot(w));
  out.max_distance = n.scale * distance.maxCoeff();
  out.success = true;
  return out;
}

CircleFit fit_circle(const Matrix3Xd& points) {
  const Normalised n = normalise(points, 3);
  CircleFit out;
  CurvedFrame frame;
  FitQuality quality;
  if (!solve_circle(n, &frame, &quality)) return out;
  static_cast<FitQuality&>(out) = quality;
  rescale(n.scale, &out);
  out.radius = n.scale / frame.curvature;
  out.centre = n.restore(frame.point + frame.axes.col(1) / frame.curvature);
  out.normal = frame.axes.col(2).normalized();
  return out;
}

ArcFit fit_arc(const Matrix3Xd& points) {
  const Normalised n = normalise(points, 3);
  ArcFit out;
  CurvedFrame frame;
  FitQuality quality;
  if (!solve_circle(n, &frame, &quality)) return out;
  // Angles of the points, each the nearest turn to the one before.
  double last = 0, first = 0, low = 0, high = 0;
  for (int i = 0; i < n.points.cols(); ++i) {
    const Vector3d local = frame.axes.transpose() * (n.points.col(i) - frame.point);
    double angle = std::atan2(frame.curvature * local.x(), 1 - frame.curvature * local.y());
    if (i == 0) {
      first = low = high = last = angle;
    } else {
      last += std::remainder(angle - last, 2 * M_PI);
      low = std::min(low, last);
      high = std::max(high, last);
    }
  }
  if (!(high - low < 2 * M_PI - 1e-6) || !(high > low)) return out;
  if (last < first) std::swap(low, high);
  static_cast<FitQuality&>(out) = quality;
  rescale(n.scale, &out);
  out.begin = n.restore(frame.at(low));
  out.apex = n.restore(frame.at(0.5 * (low + high)));
  out.end = n.restore(frame.at(high));
  return out;
}

ArcFit fit_arc(const Matrix3Xd& points, const Vector3d& begin, const Vector3d& end) {
  ArcFit out;
  Matrix3Xd all(3, points.cols() + 2);
  all << points, begin, end;
  const Normalised n = normalise(all, 3);
  if (!n.usable || !((end - begin).norm() > 1e-12 * n.scale)) return out;
  ControlPoints c;
  c.count = 3;
  c.p = {n.apply(begin), Vector3d::Zero(), n.apply(end), Vector3d::Zero()};
  // Start through the point that is farthest off the chord, at the sagitta of a circle through it.
  const Vector3d along = (c.p[2] - c.p[0]).normalized(), middle = (c.p[0] + c.p[2]) / 2;
  const double half = (c.p[2] - c.p[0]).norm() / 2;
  Vector3d rise = Vector3d::Zero();
  double x = 0;
  for (int i = 0; i < points.cols(); ++i) {
    const Vector3d w = n.points.col(i) - middle, off = w - along * along.dot(w);
    if (off.norm() <= rise.norm()) continue;
    rise = off;
    x = along.dot(w);
  }
  // Circle through (-half, 0), (x, y) and (half, 0): twice the height of its centre over the chord.
  const double y = rise.norm(), twice = y > 0 ? (x * x + y * y - half * half) / y : 0;
  const double sagitta = 0.5 * (twice + std::sqrt(twice * twice + 4 * half * half));
  c.p[1] = y > 0 ? Vector3d(middle + rise / y * sagitta) : middle;
  RefineOptions options;
  options.free = {false, true, false, false};
  const FitQuality quality =
      refine_curve(StrokeKind::kArc, n.points.leftCols(points.cols()), options, &c);
  if (!quality.success || points.cols() == 0) return out;
  // Only the part of the apex square to the chord counts; the rest would be arbitrary.
  const Vector3d w = c.p[1] - middle;
  static_cast<FitQuality&>(out) = quality;
  rescale(n.scale, &out);
  out.begin = begin;
  out.apex = n.restore(middle + w - along * along.dot(w));
  out.end = end;
  return out;
}

}  // namespace sketchsplat
