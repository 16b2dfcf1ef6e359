// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

namespace sketchsplat {

/// Widest gap [rad] between directions around an axis; 2 pi if there is one direction. `out`:
/// 3 x N, out of the axis, N > 0.
inline double widest_gap(const Eigen::Matrix3Xd& out, const Eigen::Vector3d& axis) {
  const Eigen::Vector3d u = axis.unitOrthogonal(), v = axis.cross(u);
  std::vector<double> at;
  for (Eigen::Index i = 0; i < out.cols(); ++i)
    at.push_back(std::atan2(out.col(i).dot(v), out.col(i).dot(u)));
  std::sort(at.begin(), at.end());
  double gap = at.front() + 2 * M_PI - at.back();
  for (size_t k = 1; k < at.size(); ++k) gap = std::max(gap, at[k] - at[k - 1]);
  return gap;
}

}  // namespace sketchsplat
