// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>
#include <random>

#include "edges/surfels/model/surfel_set.h"
#include "edges/surfels/model/surfel_shading.h"

namespace sketchsplat {

constexpr double kSpacing = 0.05;
constexpr int kSide = 24;

/// A grid of surfels, kSide x kSide at kSpacing, on a surface given by its points and normals, with
/// errors as fits have them: 5 % of the spacing and 1.5 deg about each axis.
inline SurfelSet noisy(
    const std::function<void(double, double, Eigen::Vector3d*, Eigen::Vector3d*)>& surface) {
  std::mt19937 random(7);
  std::normal_distribution<double> error;
  SurfelSet set;
  set.values = Eigen::MatrixXd::Zero(SurfelSet::kRows, kSide * kSide);
  for (int i = 0; i < set.size(); ++i) {
    Eigen::Vector3d p, n;
    surface(kSpacing * (i % kSide), kSpacing * (i / kSide), &p, &n);
    const Eigen::Vector3d tilt(error(random), error(random), error(random));
    set.values.col(i).segment<3>(SurfelSet::kCenter) = p + 0.05 * kSpacing * error(random) * n;
    set.values.col(i).segment<4>(SurfelSet::kRotation) =
        rotation_to((n + 0.02 * tilt).normalized());
  }
  return set;
}

}  // namespace sketchsplat
