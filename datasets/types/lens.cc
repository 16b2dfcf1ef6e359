// SPDX-License-Identifier: MIT
#include "datasets/types/lens.h"

#include <Eigen/LU>
#include <algorithm>
#include <initializer_list>

#include "datasets/types/dense.h"

namespace sketchsplat {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Smallest positive root of 1 + a1 t + a2 t^2 + ...; infinite if there is none. The reversed
/// polynomial is monic in 1 / t, so that no leading coefficient is too small to divide by.
double first_root(std::initializer_list<double> coefficients) {
  const Eigen::VectorXd reversed =
      Eigen::Map<const Eigen::VectorXd>(coefficients.begin(), Eigen::Index(coefficients.size()));
  double largest = 0;  // of 1 / t
  for (const std::complex<double>& inverse : polynomial_roots(reversed))
    if (std::abs(inverse.imag()) <= 1e-9 * std::abs(inverse))
      largest = std::max(largest, inverse.real());
  return largest > 1e-8 ? 1 / largest : kInfinity;
}

/// Where the distorted radius stops growing.
double find_range(LensModel model, const Lens::Terms& k) {
  if (model == LensModel::kOpencvFisheye) {
    const double angle = std::sqrt(first_root({3 * k.k1, 5 * k.k2, 7 * k.k3, 9 * k.k4}));
    return angle < M_PI / 2 ? std::tan(angle) : kInfinity;
  }
  // r N(q) / D(q), q = r^2, grows while (N + 2 q N') D - 2 q N D' > 0 and has no pole before D = 0.
  const double turn = first_root({3 * k.k1 - k.k4,                                      //
                                  5 * k.k2 + k.k1 * k.k4 - 3 * k.k5,                    //
                                  7 * k.k3 + 3 * k.k2 * k.k4 - k.k1 * k.k5 - 5 * k.k6,  //
                                  5 * k.k3 * k.k4 + k.k2 * k.k5 - 3 * k.k1 * k.k6,      //
                                  3 * k.k3 * k.k5 - k.k2 * k.k6,                        //
                                  k.k3 * k.k6});
  return std::sqrt(std::min(turn, first_root({k.k4, k.k5, k.k6})));
}

bool all_of_terms(const Lens::Terms& k, bool (*is)(double)) {
  const auto terms = {k.k1, k.k2, k.p1, k.p2, k.k3, k.k4, k.k5, k.k6};
  return std::all_of(terms.begin(), terms.end(), is);
}

/// The factor s of a point at the squared radius q, and ds/dq.
struct Scale {
  double s, slope;
};
Scale scale_at(LensModel model, const Lens::Terms& k, double q) {
  if (model == LensModel::kOpencvFisheye) {
    if (q < 1e-12) return {1, k.k1 - 1.0 / 3};  // atan(r) = r - r^3 / 3 + ...
    const double r = std::sqrt(q), angle = std::atan(r), t = angle * angle;
    const double bent = angle * (1 + t * (k.k1 + t * (k.k2 + t * (k.k3 + t * k.k4))));
    const double by_angle = 1 + t * (3 * k.k1 + t * (5 * k.k2 + t * (7 * k.k3 + t * 9 * k.k4)));
    return {bent / r, (by_angle / (1 + q) - bent / r) / (2 * q)};
  }
  const double n = 1 + q * (k.k1 + q * (k.k2 + q * k.k3));
  const double d = 1 + q * (k.k4 + q * (k.k5 + q * k.k6));
  const double by_n = k.k1 + q * (2 * k.k2 + q * 3 * k.k3);
  const double by_d = k.k4 + q * (2 * k.k5 + q * 3 * k.k6);
  return {n / d, (by_n * d - n * by_d) / (d * d)};
}

}  // namespace

Lens::Lens(LensModel model, const Terms& terms) : model_(model), terms_(terms) {
  identity_ =
      model == LensModel::kPinhole || (model != LensModel::kOpencvFisheye &&
                                       all_of_terms(terms, [](double term) { return term == 0; }));
  if (!identity_) range_ = is_finite() ? find_range(model, terms) : 0;
}

bool Lens::is_finite() const {
  return all_of_terms(terms_, [](double term) { return std::isfinite(term); });
}

Eigen::Matrix2d Lens::jacobian(const Eigen::Vector2d& ideal) const {
  if (identity_) return Eigen::Matrix2d::Identity();
  const double x = ideal.x(), y = ideal.y();
  const Scale scale = scale_at(model_, terms_, x * x + y * y);
  Eigen::Matrix2d J =
      scale.s * Eigen::Matrix2d::Identity() + 2 * scale.slope * ideal * ideal.transpose();
  if (model_ == LensModel::kOpencvFisheye) return J;
  const double a = 2 * (terms_.p1 * y + terms_.p2 * x), b = 2 * (terms_.p1 * x + terms_.p2 * y);
  J(0, 0) += a + 4 * terms_.p2 * x;
  J(0, 1) += b, J(1, 0) += b;
  J(1, 1) += a + 4 * terms_.p1 * y;
  return J;
}

Eigen::Matrix<double, 2, 8> Lens::terms_jacobian(const Eigen::Vector2d& ideal) const {
  Eigen::Matrix<double, 2, 8> J = Eigen::Matrix<double, 2, 8>::Zero();
  const double x = ideal.x(), y = ideal.y(), q = x * x + y * y;
  if (model_ == LensModel::kOpencvFisheye) {
    const double r = std::sqrt(q), angle = std::atan(r), t = angle * angle;
    const Eigen::Vector2d unit = q < 1e-16 ? ideal : Eigen::Vector2d(ideal * (angle / r));
    J.col(0) = unit * t, J.col(1) = unit * t * t;
    J.col(4) = unit * t * t * t, J.col(5) = unit * t * t * t * t;
    return J;
  }
  const Terms& k = terms_;
  const double n = 1 + q * (k.k1 + q * (k.k2 + q * k.k3));
  const double d = 1 + q * (k.k4 + q * (k.k5 + q * k.k6));
  J.col(0) = ideal * (q / d), J.col(1) = q * J.col(0), J.col(4) = q * J.col(1);
  J.col(5) = -n / d * J.col(0), J.col(6) = q * J.col(5), J.col(7) = q * J.col(6);
  J.col(2) << 2 * x * y, q + 2 * y * y;
  J.col(3) << q + 2 * x * x, 2 * x * y;
  return J;
}

bool Lens::undistort(const Eigen::Vector2d& distorted, Eigen::Vector2d* ideal) const {
  if (identity_) {
    *ideal = distorted;
    return distorted.allFinite();
  }
  const double tolerance = 1e-13 * (1 + distorted.norm());
  Eigen::Vector2d at = distorted;
  if (!(at.norm() < 0.9 * range_)) at *= 0.9 * range_ / at.norm();
  Eigen::Vector2d off = distorted - distort(at);
  Eigen::Vector2d step = Eigen::Vector2d::Zero();
  const auto moved = [&](double part) {  // if that helps and does not go over the fold
    const Eigen::Vector2d next = at + part * step;
    if (!draws(next)) return false;
    const Eigen::Vector2d then = distorted - distort(next);
    if (!(then.norm() < off.norm())) return false;
    at = next, off = then;
    return true;
  };
  for (int round = 0; round < 50 && off.norm() > tolerance; ++round) {
    step = jacobian(at).inverse() * off;
    double part = 1;
    while (!moved(part) && part > 1e-4) part *= 0.5;
    if (!(part > 1e-4)) break;
  }
  *ideal = at;
  return off.norm() <= 10 * tolerance && draws(at) && jacobian(at).determinant() > 0;
}

}  // namespace sketchsplat
