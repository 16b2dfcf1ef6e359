// SPDX-License-Identifier: MIT
#include "eval/metrics/map_errors.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "datasets/types/median.h"

namespace sketchsplat {

MapErrors score_geometry(const GeometryMaps& maps, const GeometryMaps& truth,
                         const Camera& camera) {
  MapErrors errors;
  std::vector<double> depths;
  size_t object = 0;
  const auto normal = [](const GeometryMaps& m, size_t i) {
    return Eigen::Vector3d(m.normal[0].data[i], m.normal[1].data[i], m.normal[2].data[i]);
  };
  for (size_t i = 0; i < truth.depth.data.size(); ++i) {
    const Eigen::Vector3d t = normal(truth, i), n = normal(maps, i);
    const double z = truth.depth.data[i];
    if (!(z > 0) || !std::isfinite(z) || !(t.norm() > 0)) continue;
    ++object;
    if (!(maps.depth.data[i] > 0) || !(n.norm() > 0)) continue;
    errors.normal_deg += std::atan2(n.cross(t).norm(), n.dot(t)) * 180 / M_PI;
    depths.push_back(std::abs(maps.depth.data[i] - z) * camera.fx / z);
  }
  if (depths.empty()) return {};
  errors.normal_deg /= double(depths.size());
  errors.covered = double(depths.size()) / double(object);
  errors.depth_px = median(std::move(depths));
  return errors;
}

}  // namespace sketchsplat
