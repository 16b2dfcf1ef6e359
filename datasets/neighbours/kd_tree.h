// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

namespace sketchsplat {

/// Points in space that can be asked for those near a place. Exact, in double precision; queries
/// may run in parallel.
class KdTree {
 public:
  /// `points` 3 x N, finite; N may be 0.
  explicit KdTree(const Eigen::Matrix3Xd& points);
  ~KdTree();
  KdTree(KdTree&&) noexcept;

  /// Euclidean distance to the nearest point; infinite if there is none.
  double distance(const Eigen::Vector3d& place) const;

  /// Indices of the points nearer than `radius`, ascending.
  std::vector<int> within(const Eigen::Vector3d& place, double radius) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace sketchsplat
