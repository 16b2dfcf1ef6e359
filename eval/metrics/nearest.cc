// SPDX-License-Identifier: MIT
#include "eval/metrics/nearest.h"

namespace sketchsplat {

NearestPoints::NearestPoints(const Eigen::Matrix3Xd& points) : tree_(points) {}

Eigen::VectorXd NearestPoints::distances(const Eigen::Matrix3Xd& queries) const {
  Eigen::VectorXd out(queries.cols());
#pragma omp parallel for schedule(dynamic, 1024) if (queries.cols() > 8192)
  for (Eigen::Index i = 0; i < queries.cols(); ++i) out[i] = tree_.distance(queries.col(i));
  return out;
}

}  // namespace sketchsplat
