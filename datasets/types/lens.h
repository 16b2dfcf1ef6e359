// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>

namespace sketchsplat {

/// What a lens does, by COLMAP's names (its src/colmap/sensor/models.h).
enum class LensModel { kPinhole, kSimpleRadial, kRadial, kOpencv, kFullOpencv, kOpencvFisheye };

/// Parameters by OpenCV's names and in its order, which COLMAP's FULL_OPENCV has, too; the simpler
/// models leave the last ones at zero. The `k` of SIMPLE_RADIAL is k1; OPENCV_FISHEYE has k1 to k4.
template <typename T>
struct LensTerms {
  T k1 = T(0), k2 = T(0), p1 = T(0), p2 = T(0), k3 = T(0), k4 = T(0), k5 = T(0), k6 = T(0);
};

/// From ideal image coordinates (x / z, y / z) to those where the lens draws the point. With
/// q = x^2 + y^2, OPENCV_FISHEYE scales by (1 + k1 t^2 + k2 t^4 + k3 t^6 + k4 t^8) t / sqrt(q),
/// t = atan(sqrt(q)) (Kannala and Brandt, PAMI 2006); all others are
///   s = (1 + k1 q + k2 q^2 + k3 q^3) / (1 + k4 q + k5 q^2 + k6 q^3)
///   x' = s x + 2 p1 x y + p2 (q + 2 x^2),  y' = s y + p1 (q + 2 y^2) + 2 p2 x y
/// (Brown 1966; OpenCV's calib3d documentation). T: double or an automatic derivative.
template <typename T>
Eigen::Matrix<T, 2, 1> distort(LensModel model, const LensTerms<T>& k,
                               const Eigen::Matrix<T, 2, 1>& xy) {
  using std::atan;
  using std::sqrt;
  const T &x = xy[0], &y = xy[1], q = x * x + y * y;
  if (model == LensModel::kPinhole) return xy;
  if (model == LensModel::kOpencvFisheye) {
    if (q < T(1e-16)) return xy;
    const T r = sqrt(q), angle = atan(r), t = angle * angle;
    return xy * (angle / r * (T(1) + t * (k.k1 + t * (k.k2 + t * (k.k3 + t * k.k4)))));
  }
  const T s =
      (T(1) + q * (k.k1 + q * (k.k2 + q * k.k3))) / (T(1) + q * (k.k4 + q * (k.k5 + q * k.k6)));
  const T xy2 = T(2) * x * y;
  return {s * x + k.p1 * xy2 + k.p2 * (q + T(2) * x * x),
          s * y + k.p1 * (q + T(2) * y * y) + k.p2 * xy2};
}

/// The distortion of a camera. Without arguments there is none.
class Lens {
 public:
  using Terms = LensTerms<double>;

  Lens() = default;
  Lens(LensModel model, const Terms& terms);

  LensModel model() const { return model_; }
  const Terms& terms() const { return terms_; }
  /// Does it draw every point where a pinhole would?
  bool is_identity() const { return identity_; }
  /// Are all parameters numbers? If not, it draws nothing.
  bool is_finite() const;
  /// Radius in ideal coordinates up to which the distorted radius grows with it (tangential terms
  /// left out); beyond, the formula folds back and means nothing. Infinite if it never does.
  double range() const { return range_; }
  /// Is there a picture of this point at all?
  bool draws(const Eigen::Vector2d& ideal) const { return ideal.norm() < range_; }

  /// See distort() above. Precondition: draws(ideal).
  Eigen::Vector2d distort(const Eigen::Vector2d& ideal) const {
    return identity_ ? ideal : sketchsplat::distort(model_, terms_, ideal);
  }
  /// d(distorted) / d(ideal).
  Eigen::Matrix2d jacobian(const Eigen::Vector2d& ideal) const;
  /// d(distorted) / d(k1, k2, p1, p2, k3, k4, k5, k6); of OPENCV_FISHEYE, p1, p2, k5 and k6 are
  /// nothing.
  Eigen::Matrix<double, 2, 8> terms_jacobian(const Eigen::Vector2d& ideal) const;
  /// The ideal point that is drawn at a distorted one, to 1e-12 (Newton). False if none in the
  /// range is.
  bool undistort(const Eigen::Vector2d& distorted, Eigen::Vector2d* ideal) const;

 private:
  LensModel model_ = LensModel::kPinhole;
  Terms terms_;
  bool identity_ = true;
  double range_ = std::numeric_limits<double>::infinity();
};

}  // namespace sketchsplat
