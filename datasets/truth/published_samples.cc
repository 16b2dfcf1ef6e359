// SPDX-License-Identifier: MIT
#include "datasets/truth/published_samples.h"

#include <cmath>

namespace sketchsplat {

Eigen::Matrix3Xd concatenate(const std::vector<Eigen::Matrix3Xd>& parts) {
  Eigen::Index count = 0, at = 0;
  for (const auto& part : parts) count += part.cols();
  Eigen::Matrix3Xd all(3, count);
  for (const auto& part : parts) {
    all.middleCols(at, part.cols()) = part;
    at += part.cols();
  }
  return all;
}

double floor_divide(double a, double b) {
  if (b == 0) return a / b;
  double rest = std::fmod(a, b);
  double quotient = (a - rest) / b;
  if (rest != 0 && (b < 0) != (rest < 0)) quotient -= 1;
  if (quotient == 0) return std::copysign(0.0, a / b);
  const double whole = std::floor(quotient);
  return quotient - whole > 0.5 ? whole + 1 : whole;
}

Eigen::Matrix3Xd sample_segments(const Eigen::Matrix3Xd& polyline, double interval) {
  std::vector<double> out;
  for (Eigen::Index k = 0; k + 1 < polyline.cols(); ++k) {
    const Eigen::Vector3d a = polyline.col(k), b = polyline.col(k + 1);
    const int count = int(floor_divide((b - a).norm(), interval));
    for (int i = 0; i < count; ++i) {
      const double w = linspace01(i, count);
      for (int c = 0; c < 3; ++c) out.push_back(w * a[c] + (1 - w) * b[c]);
    }
  }
  return Eigen::Map<Eigen::Matrix3Xd>(out.data(), 3, Eigen::Index(out.size() / 3));
}

}  // namespace sketchsplat
