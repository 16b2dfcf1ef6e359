// SPDX-License-Identifier: MIT
#include "edges/sight_lines.h"

#include <cmath>

namespace sketchsplat {

std::vector<SightLine> sight_lines(const EdgeWorld& world, const std::vector<EdgePoint>& points,
                                   const SightOptions& options) {
  const double most = std::sin(options.angle_deg * M_PI / 180);
  const double beside = std::cos(options.beside_deg * M_PI / 180);
  std::vector<std::vector<SightLine>> of_view(world.views.size());
#pragma omp parallel for schedule(dynamic, 1)
  for (int v = 0; v < int(world.views.size()); ++v) {
    const View& view = world.views[v];
    const EdgelMap& map = world.maps[v];
    const Eigen::Vector3d eye = view.center_in_world();
    for (const EdgePoint& p : points) {
      double z = 0;
      const Eigen::Vector2d q = view.project(p.position, &z);
      const Eigen::Vector3d from = world.views[p.view].center_in_world() - p.position;
      const Eigen::Vector3d to = eye - p.position;
      if (!(z > 0) || from.dot(to) < beside * from.norm() * to.norm()) continue;
      const int k = map.nearest_at(q.x(), q.y());
      if (k < 0) continue;
      const Edgel& e = map.edgels[k];
      const double across = (q.x() - e.x) * e.nx + (q.y() - e.y) * e.ny;
      const double away = std::hypot(q.x() - e.x, q.y() - e.y);
      const double turn = world.plane_normal[v].col(k).cast<double>().dot(p.tangent);
      if (std::abs(across) <= options.reach_px && away <= 2 * options.reach_px &&
          std::abs(turn) <= most)
        of_view[v].push_back({eye, p.position});
    }
  }
  std::vector<SightLine> lines;
  for (const auto& some : of_view) lines.insert(lines.end(), some.begin(), some.end());
  return lines;
}

}  // namespace sketchsplat
