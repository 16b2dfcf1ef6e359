// SPDX-License-Identifier: MIT
#include "sketches/fit/ellipse_run.h"

#include <algorithm>
#include <cmath>

#include "datasets/types/dense.h"
#include "sketches/curve/conic.h"
#include "sketches/fit/refine.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Matrix9d = Eigen::Matrix<double, 9, 9>;
using Vector9d = Eigen::Matrix<double, 9, 1>;

constexpr double kSlender = 0.05;  // least ratio of the semi-axes
constexpr double kLongest = 50;        // largest semi-axis, times the spread
constexpr int kSteps = 12;

// Centre, p and q as columns; points are normalised.
using Ellipse = Eigen::Matrix3d;

Vector3d basis(double psi) { return {1, std::cos(psi), std::sin(psi)}; }
Vector3d slope_basis(double psi) { return {0, -std::sin(psi), std::cos(psi)}; }

// Newton towards the nearest places from where they were; returns the weighted squared distances.
double project(const Matrix3Xd& points, const Eigen::VectorXd& weights, const Ellipse& e,
               Eigen::VectorXd* angle, Eigen::VectorXd* distance) {
  for (int i = 0; i < points.cols(); ++i) {
    double& psi = (*angle)[i];
    Vector3d r;
    for (int step = 0; step < 3; ++step) {
      const Vector3d x = e * basis(psi), d = e * slope_basis(psi);
      r = points.col(i) - x;
      if (step == 2) break;
      const double second = d.squaredNorm() + r.dot(x - e.col(0));
      if (second > 1e-3 * d.squaredNorm() && d.squaredNorm() > 0)
        psi += std::clamp(r.dot(d) / second, -0.3, 0.3);
    }
    (*distance)[i] = r.norm();
  }
  return distance->cwiseAbs2().dot(weights);
}

// Damped Gauss-Newton step on the distances square to the ellipse. The phase of p and q only slides
// points along it: the damping settles that.
Ellipse step(const Matrix3Xd& points, const Eigen::VectorXd& weights, const Ellipse& e,
             const Eigen::VectorXd& angle, double lambda) {
  Matrix9d H = Matrix9d::Zero();
  Vector9d g = Vector9d::Zero();
  for (int i = 0; i < points.cols(); ++i) {
    const Vector3d w = basis(angle[i]), u = (e * slope_basis(angle[i])).stableNormalized();
    const Eigen::Matrix3d P = weights[i] * (Eigen::Matrix3d::Identity() - u * u.transpose());
    const Vector3d r = P * (points.col(i) - e * w);
    for (int a = 0; a < 3; ++a) {
      g.segment<3>(3 * a) += w[a] * r;
      for (int b = 0; b <= a; ++b) H.block<3, 3>(3 * a, 3 * b) += w[a] * w[b] * P;
    }
  }
  H.diagonal().array() += lambda * H.trace() / 9;
  const Vector9d x = solve_symmetric(H, g);
  return e + Eigen::Map<const Ellipse>(x.data());
}

bool is_usable(const Ellipse& e) {
  if (!e.allFinite()) return false;
  const EllipseAxes axes = principal_axes(e.col(1), e.col(2));
  const double a = axes.major.norm();
  return a < kLongest && axes.minor.norm() > kSlender * a;
}

// Angles about a start whose semi-axes are orthogonal, unwrapped along the run.
Eigen::VectorXd first_angles(const Matrix3Xd& points, const Ellipse& e) {
  Eigen::VectorXd angle(points.cols());
  for (int i = 0; i < points.cols(); ++i) {
    const Vector3d v = points.col(i) - e.col(0);
    const double psi = std::atan2(v.dot(e.col(2)) / e.col(2).squaredNorm(),
                                  v.dot(e.col(1)) / e.col(1).squaredNorm());
    angle[i] = i == 0 ? psi : angle[i - 1] + std::remainder(psi - angle[i - 1], 2 * M_PI);
  }
  return angle;
}

}  // namespace

EllipseRun ellipse_through_runs(const Matrix3Xd& points, const Eigen::VectorXd& weights) {
  EllipseRun out;
  const Normalised n = normalise(points, 8);
  ControlPoints c;
  if (!n.usable || !start_ellipse(n, &c)) return out;
  Ellipse e;
  e << c.p[0], c.p[1], c.p[2];
  if (!e.allFinite() || !(e.col(1).norm() > 0) || !(e.col(2).norm() > 0)) return out;
  const Eigen::VectorXd w = weights.size()
                                ? Eigen::VectorXd(weights / weights.mean())
                                : Eigen::VectorXd(Eigen::VectorXd::Ones(n.points.cols()));
  Eigen::VectorXd angle = first_angles(n.points, e), distance(angle.size());
  double cost = project(n.points, w, e, &angle, &distance), lambda = 1e-4;
  for (int k = 0; k < kSteps && lambda < 1e4; ++k) {
    const Ellipse moved = step(n.points, w, e, angle, lambda);
    Eigen::VectorXd new_angle = angle, new_distance = distance;
    const double now = project(n.points, w, moved, &new_angle, &new_distance);
    if (!(now < cost)) {
      lambda *= 10;
      continue;
    }
    const bool settled = cost - now < 1e-4 * now || now < 1e-24 * double(angle.size());
    e = moved, angle = new_angle, distance = new_distance, cost = now;
    lambda = std::max(0.1 * lambda, 1e-9);
    if (settled) break;
  }
  if (!is_usable(e)) return out;
  out.centre = n.restore(e.col(0));
  out.p = n.scale * e.col(1), out.q = n.scale * e.col(2);
  out.angle = angle;
  out.distance = n.scale * distance;
  out.ok = out.distance.allFinite() && angle.allFinite();
  return out;
}

EllipseRun ellipse_along(const Matrix3Xd& points) {
  EllipseRun out = ellipse_through_runs(points);
  if (out.sweep() < 0) out.angle *= -1, out.q *= -1;
  out.ok = out.ok && out.sweep() >= kLeastEllipseSweep;
  return out;
}

}  // namespace sketchsplat
