// SPDX-License-Identifier: MIT
#include "edges/surfels/model/surfel_smooth.h"

#include <algorithm>
#include <cmath>

#include "edges/surfels/model/surfel_shading.h"

namespace sketchsplat {

double smooth_gradient(const SurfelCloud& cloud, const std::vector<std::pair<int, int>>& pairs,
                       double spacing, double edge_deg, double weight, SurfelCloud* gradient) {
  if (pairs.empty()) return 0;
  const int n = cloud.size();
  Eigen::Matrix3Xd normal(3, n), by_normal = Eigen::Matrix3Xd::Zero(3, n);
  for (int i = 0; i < n; ++i) normal.col(i) = surfel_normal(cloud.rotation.col(i));
  const double share = weight / pairs.size(), edge = edge_deg * M_PI / 180;
  double value = 0;
  for (const auto& [i, j] : pairs) {
    const double cosine = normal.col(i).dot(normal.col(j));
    const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
    const double w = share * std::exp(-angle * angle / (edge * edge));
    const Eigen::Vector3d away = (cloud.center.col(j) - cloud.center.col(i)) / spacing;
    const Eigen::Vector3d mean = 0.5 * (normal.col(i) + normal.col(j));
    const double off = away.dot(mean);
    value += w * (1 - cosine + off * off);
    by_normal.col(i) += w * (-normal.col(j) + off * away);
    by_normal.col(j) += w * (-normal.col(i) + off * away);
    const Eigen::Vector3d by_center = 2 * w * off / spacing * mean;
    gradient->center.col(j) += by_center;
    gradient->center.col(i) -= by_center;
  }
  for (int i = 0; i < n; ++i) {
    Eigen::Matrix<double, 3, 4> by_rotation;
    surfel_normal(cloud.rotation.col(i), &by_rotation);
    gradient->rotation.col(i) += by_rotation.transpose() * by_normal.col(i);
  }
  return value;
}

}  // namespace sketchsplat
