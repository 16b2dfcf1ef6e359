// SPDX-License-Identifier: MIT
#include "eval/metrics/nearest.h"

#include "datasets/types/parallel.h"

namespace sketchsplat {

NearestPoints::NearestPoints(const Eigen::Matrix3Xd& points) : tree_(points) {}

Eigen::VectorXd NearestPoints::distances(const Eigen::Matrix3Xd& queries) const {
  Eigen::VectorXd out(queries.cols());
  parallel_for(int(queries.cols()), 1024, [&](int i) { out[i] = tree_.distance(queries.col(i)); });
  return out;
}

}  // namespace sketchsplat
