// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "pipelines/survey/round_judge.h"
#include "tests/support/strokes.h"

namespace sketchsplat::test {

const Eigen::Vector3d kMiddle(0.5, 0.5, 0.5);
constexpr double kPixel = 3.0 / 500;
constexpr float kSharp = 1.1f;

// Where on a round corner of a square, with sides at 0.8, a camera in its plane sees most: where a
// line of sight touches it, or else where its shading happens to be strongest for that camera.
inline Eigen::Vector2d strongest(const Eigen::Vector2d& camera, double radius, int view,
                                 bool contour) {
  const Eigen::Vector2d centre(0.8 - radius, 0.8 - radius), to = camera - centre;
  const double away = std::atan2(to.y(), to.x()), half = std::acos(radius / to.norm());
  double angle = M_PI / 4 * (1 + 0.6 * std::sin(view));
  for (const double touching : {away - half, away + half})
    if (contour && touching > 0 && touching < M_PI / 2) angle = touching;
  return centre + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
}

// The brighter side of edgels is that of the cube.
inline void turn_to_middle(const View& view, EdgelMap* map) {
  double depth;
  const Eigen::Vector2d middle = view.project(kMiddle, &depth);
  for (Edgel& e : map->edgels)
    if ((middle.x() - e.x) * e.nx + (middle.y() - e.y) * e.ny < 0) e.nx *= -1, e.ny *= -1;
}

// A cube seen by many, one edge of which is rounded: where it is no outline it shows `inner` times
// as wide as edges. All pictures are `blur` times as wide as usual. The stroke lies where it is
// nearest to what all views show.
struct RoundedCube {
  Sketch sketch;
  int rounded = -1;
  EdgeWorld world;
  explicit RoundedCube(double radius_px, float inner = 1, float blur = 1) {
    const double radius = radius_px * kPixel;
    const Eigen::Vector3d a(0.2, 0.8, 0.8), b(0.8, 0.8, 0.8);
    for (const Polyline& e : cube_edges({0.2, 0.2, 0.2}, 0.6)) {
      const int s = add_line(&sketch, e[0], e[1]);
      if ((e[0] - a).norm() < 1e-9 && (e[1] - b).norm() < 1e-9) rounded = s;
    }
    const double in = radius * (1 - 1.1 * std::sqrt(0.5));
    for (int n : {sketch.strokes[rounded].begin, sketch.strokes[rounded].end})
      sketch.nodes.col(n) -= Eigen::Vector3d(0, in, in);
    const std::vector<View> views = ring_of_views(40, kMiddle, 3);
    std::vector<EdgelMap> maps;
    for (const View& view : views) {
      const Eigen::Vector3d c = view.center_in_world();
      const bool contour = (c.y() > 0.8) != (c.z() > 0.8);
      const Eigen::Vector2d at = strongest({c.y(), c.z()}, radius, int(maps.size()), contour);
      std::vector<Polyline> seen = polylines_of(sketch);
      seen[rounded] = segment({0.2, at.x(), at.y()}, {0.8, at.x(), at.y()});
      EdgelMap map = ideal_edgels(view, seen);
      turn_to_middle(view, &map);
      for (Edgel& e : map.edgels) e.width = kSharp * blur;
      const size_t first = map.chain[rounded], end = map.chain[rounded + 1];
      for (size_t i = first; i < end; ++i) {
        map.edgels[i].outline = contour;
        if (!contour) map.edgels[i].width *= inner;
      }
      maps.push_back(map);
    }
    world = make_edge_world(views, maps);
  }
  double nats(const RoundModel& model = {}) const {
    const Observation wide = observe_rounds(sketch, world, 0);
    return RoundJudge(world, wide, model).nats(rounded, nullptr);
  }
};

}  // namespace sketchsplat::test
