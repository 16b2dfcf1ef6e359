// SPDX-License-Identifier: MIT
// Polylines as points, as the published evaluators take them.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace sketchsplat {

/// Python's and numpy's a // b for floats: not floor(a / b). 0.015 // 0.005 is 2.
double floor_divide(double a, double b);

/// i-th of `count` values from 0 to 1 as numpy's linspace(0, 1, count) rounds them.
inline double linspace01(int i, int count) {
  return i > 0 && i == count - 1 ? 1.0 : i * (1.0 / (count > 1 ? count - 1 : 1));
}

/// Samples of a polyline as the published evaluators take them: |segment| // interval of each
/// segment, both of its ends included, from its second point to its first. 3 x N.
Eigen::Matrix3Xd sample_segments(const Eigen::Matrix3Xd& polyline, double interval);

/// Columns one set after the other.
Eigen::Matrix3Xd concatenate(const std::vector<Eigen::Matrix3Xd>& parts);

}  // namespace sketchsplat
