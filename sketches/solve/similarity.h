// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// x -> scale * rotation * x + translation.
struct Similarity {
  double scale = 1;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  Eigen::Vector3d operator*(const Eigen::Vector3d& x) const {
    return scale * (rotation * x) + translation;
  }
  /// First `before`, then this one.
  Similarity operator*(const Similarity& before) const {
    return {scale * before.scale, rotation * before.rotation, *this * before.translation};
  }
  Similarity inverse() const;
};

/// exp of the cross product with a vector [rad].
Eigen::Matrix3d rotation_about(const Eigen::Vector3d& angle);

/// The sketch somewhere else, with its sigmas and covariances.
Sketch moved(const Sketch& sketch, const Similarity& by);

}  // namespace sketchsplat
