// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

namespace sketchsplat {

/// An opening in a plane, a closed loop of curves, through which views see what lies behind it: the
/// rim of a pocket or of a hole. What lies beside it hides everything behind. Or one side of a
/// plane, from which views see what lies in it: the border of a face.
class Window {
 public:
  /// Open to all cameras on the side of `normal` (of any length) of the plane through a point.
  static Window one_side(const Eigen::Vector3d& normal, const Eigen::Vector3d& point);

  /// `curves`: 3 x n points along each curve of the loop, in any order and direction, joined in
  /// common ends; all near one plane across `normal` (of any length).
  Window(const Eigen::Vector3d& normal, const std::vector<Eigen::Matrix3Xd>& curves);

  /// Does the line of sight from a point to a camera pass through the opening? Not if both are on
  /// one side of it. Of one side of a plane: is the camera there?
  bool lets_through(const Eigen::Vector3d& point, const Eigen::Vector3d& camera) const;

 private:
  Eigen::Vector3d normal_, middle_;
  bool one_side_ = false;
  Eigen::Matrix<double, 2, 3> frame_ = Eigen::Matrix<double, 2, 3>::Zero();
  std::vector<Eigen::Vector4d> sides_;  // in the plane: from x, y to x, y
};

/// Does one of them?
bool any_lets_through(const std::vector<Window>& windows, const Eigen::Vector3d& point,
                      const Eigen::Vector3d& camera);

}  // namespace sketchsplat
