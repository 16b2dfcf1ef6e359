// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace sketchsplat {

/// Rigid transform: x_in_target = rotation * x_in_source + translation. Named target_from_source.
struct Pose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  Eigen::Vector3d operator*(const Eigen::Vector3d& x) const { return rotation * x + translation; }
  Pose inverse() const { return {rotation.transpose(), -(rotation.transpose() * translation)}; }
};

}  // namespace sketchsplat
