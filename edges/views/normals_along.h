// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

namespace sketchsplat {

/// Two unit normals of a curve at each of its samples, which turn about it no more than it does.
/// `tangent`: 3 x N, unit, N at least 1.
inline std::vector<Eigen::Matrix<double, 3, 2>> normals_along(const Eigen::Matrix3Xd& tangent) {
  std::vector<Eigen::Matrix<double, 3, 2>> out(size_t(tangent.cols()));
  Eigen::Vector3d last = tangent.col(0).unitOrthogonal();
  for (int i = 0; i < tangent.cols(); ++i) {
    const Eigen::Vector3d t = tangent.col(i);
    last = (last - t * t.dot(last)).normalized();
    out[size_t(i)] << last, t.cross(last);
  }
  return out;
}

}  // namespace sketchsplat
