// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "datasets/neighbours/kd_tree.h"

namespace sketchsplat {

/// Points that can be asked for the distance to the nearest of them. Exact; double precision.
class NearestPoints {
 public:
  /// `points` 3 x N; N may be 0.
  explicit NearestPoints(const Eigen::Matrix3Xd& points);

  /// Euclidean distances of the columns of `queries` (3 x M) to the nearest point, M values;
  /// infinite if there are no points. The same for any number of threads.
  Eigen::VectorXd distances(const Eigen::Matrix3Xd& queries) const;

 private:
  KdTree tree_;
};

}  // namespace sketchsplat
