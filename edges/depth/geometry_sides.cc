// SPDX-License-Identifier: MIT
#include "edges/depth/geometry_sides.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "datasets/types/dense.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr float kRise = 1.5f, kSureRise = 2.5f;  // the latter where staircases of alpha are near
constexpr double kSmeared = 2.2;  // [px] of either side that renderers mix with the other

// How far the side goes: until the activity, having fallen, is `rise` times as large again, or the
// object ends.
double extent_of(const GeometryFields& f, const Place& p, int sign, double longest, float rise) {
  float lowest = 1e9f;
  for (double s = 0.5; s <= longest; s += 0.5) {
    const int x = int(std::lround(p.x + sign * s * p.nx));
    const int y = int(std::lround(p.y + sign * s * p.ny));
    if (x < 0 || y < 0 || x >= f.valid.cols || y >= f.valid.rows) return s - 0.5;
    if (!f.valid(y, x)) {
      if (s > 1) return s - 0.5;
      continue;  // an outline runs between its pixels
    }
    const float a = f.activity(y, x);
    if (s > 1 && a > rise * lowest + 0.3f) return s - 1;
    lowest = std::min(lowest, a);
  }
  return longest;
}

// Slopes of 1 / depth that the normal implies: on a plane n.x = d it is n.r / d, r the ray.
void slopes_of_normal(const GeometryFields& f, const Place& p, Side* side) {
  const Vector3d ray = f.camera.ray({p.x, p.y});
  const double facing = side->normal.dot(ray);
  if (std::abs(facing) < 0.02 * ray.norm()) return;
  const double gx = side->normal.x() / f.camera.fx / facing;
  const double gy = side->normal.y() / f.camera.fy / facing;
  side->inverse_s = side->inverse * (gx * p.nx + gy * p.ny);
  side->inverse_t = side->inverse * (gy * p.nx - gx * p.ny);
}

// Squared cosine between normal and line of sight in a part of a side: by the mean normal and by
// the plane through the depths, of which the mean counts.
bool facing_in(const GeometryFields& f, const Place& p, double from, double to, double* facing) {
  Matrix3d A = Matrix3d::Zero();
  Vector3d b = Vector3d::Zero(), normal = Vector3d::Zero();
  int n = 0;
  for_each_pixel(f, p, from, to, [&](double s, double t, const cv::Point& at) {
    const Vector3d basis(1, s, t);
    A += basis * basis.transpose();
    b += basis * f.inverse(at);
    normal += Vector3d(f.normal[0](at), f.normal[1](at), f.normal[2](at));
    ++n;
  });
  if (n < 6) return false;
  const double s = 0.5 * (from + to);
  const Vector3d plane = solve_symmetric(A, b),
                 ray = f.camera.ray({p.x + s * p.nx, p.y + s * p.ny});
  const double w = plane[0] + plane[1] * s, cosine = normal.normalized().dot(ray) / ray.norm();
  if (!(w > 0)) return false;
  // The normal that the slopes of 1 / depth imply, scaled so that its product with the ray is 1.
  const double gx = f.camera.fx * (plane[1] * p.nx - plane[2] * p.ny) / w;
  const double gy = f.camera.fy * (plane[1] * p.ny + plane[2] * p.nx) / w;
  const Vector3d steep(gx, gy, 1 - gx * ray.x() - gy * ray.y());
  *facing = 0.5 * (cosine * cosine + 1 / (steep.squaredNorm() * ray.squaredNorm()));
  return true;
}

}  // namespace

double turn_of(const Side& a, const Side& b) {
  return std::atan2(a.normal.cross(b.normal).norm(), a.normal.dot(b.normal));
}

double steady_turn(const Side& a, const Side& b) {
  return kBand * std::max(a.normal_slope.norm(), b.normal_slope.norm());
}

double jump_of(const Side& a, const Side& b, double unit) {
  const double far = std::min(a.inverse, b.inverse), near = std::max(a.inverse, b.inverse);
  return unit * (near / std::max(far, 1e-3 * near) - 1);
}

double bend_of(const Side& a, const Side& b, double unit) {
  return unit * std::abs(a.inverse_s - b.inverse_s) / std::max(a.inverse, b.inverse);
}

bool is_rim(const GeometryFields& f, const Place& p, int sign) {
  constexpr double kLongest = 10, kFirst = 1.5;  // [px]
  const double end = extent_of(f, p, sign, kLongest, kSureRise), middle = 0.5 * (kFirst + end);
  if (end < kLinear) return false;
  double outer, inner;
  const auto facing = [&](double from, double to, double* value) {
    return sign > 0 ? facing_in(f, p, from, to, value) : facing_in(f, p, -to, -from, value);
  };
  if (!facing(kFirst, middle, &outer) || !facing(middle, end, &inner)) return false;
  const double slope = (inner - outer) / (0.5 * (end - kFirst));
  const double at_edge = outer - slope * 0.5 * (kFirst + middle), at_end = at_edge + slope * end;
  return slope * end > 0.03 && at_edge < 0.3 * at_end;
}

Side fit_side(const GeometryFields& f, const Place& p, int sign) {
  Side side;
  side.extent = extent_of(f, p, sign, kLongestSide * f.scale, kRise);
  if (side.extent < 1) return side;
  const double from = std::min(kSmeared * f.scale, 0.5 * side.extent);
  const double lo = sign > 0 ? from : -side.extent, hi = sign > 0 ? side.extent : -from;
  Matrix3d A = Matrix3d::Zero();
  Eigen::Matrix<double, 3, 4> B = Eigen::Matrix<double, 3, 4>::Zero();
  double squares = 0;
  for_each_pixel(f, p, lo, hi, [&](double s, double t, const cv::Point& at) {
    const Vector3d basis(1, s, t);
    const double w = f.inverse(at);
    A += basis * basis.transpose();
    B += basis * Eigen::RowVector4d(f.normal[0](at), f.normal[1](at), f.normal[2](at), w);
    squares += w * w;
    ++side.samples;
  });
  if (side.samples < 4) return side;
  const Eigen::RowVector4d mean = B.row(0) / side.samples;
  if (side.extent >= kLinear * f.scale && side.samples >= 8) {
    const Eigen::Matrix<double, 3, 4> fit = solve_symmetric(A, B);
    side.normal = fit.block<1, 3>(0, 0).transpose();
    side.normal_slope = fit.block<1, 3>(1, 0).transpose();
    side.inverse = fit(0, 3), side.inverse_s = fit(1, 3), side.inverse_t = fit(2, 3);
    side.residual =
        std::sqrt(std::max(0.0, squares - fit.col(3).dot(B.col(3))) / (side.samples - 3));
  } else {
    side.normal = mean.head<3>().transpose();
    side.inverse = mean(3);
    slopes_of_normal(f, p, &side);
    side.inverse -=
        side.inverse_s * A(0, 1) / side.samples + side.inverse_t * A(0, 2) / side.samples;
  }
  side.normal.normalize();
  return side;
}

Step fit_step(const std::vector<StepSample>& samples) {
  Step step;
  if (samples.size() < 6) return step;
  double log_sigma = 0;
  double sum_ss = 0, squares = 0;
  for (int iteration = 0; iteration < 6; ++iteration) {
    const double sigma = std::exp(log_sigma);
    Eigen::Matrix2d H = Eigen::Matrix2d::Zero();
    Eigen::Vector2d g = Eigen::Vector2d::Zero();
    squares = 0;
    for (const StepSample& q : samples) {
      const double z = (q.s - step.s) / sigma;
      const double r = q.value - 0.5 * std::erfc(-z * M_SQRT1_2);
      const double phi = 0.3989422804 * std::exp(-0.5 * z * z);
      const Eigen::Vector2d J(-phi / sigma, -phi * z);  // d value / d (s, log sigma)
      H += J * J.transpose();
      g += J * r;
      squares += r * r;
    }
    sum_ss = H(0, 0);
    H.diagonal() += Eigen::Vector2d(1e-3, 0.1);  // the width of few samples is no news
    const Eigen::Vector2d d = solve_symmetric(H, g);
    step.s += std::clamp(d[0], -0.7, 0.7);
    log_sigma = std::clamp(log_sigma + std::clamp(d[1], -0.5, 0.5), std::log(0.35), std::log(4.0));
  }
  step.sigma = std::exp(log_sigma);
  step.error = std::sqrt(squares / samples.size() / std::max(sum_ss, 1e-9));
  step.ok = std::isfinite(step.s) && squares / samples.size() < 0.06;
  return step;
}

}  // namespace sketchsplat
