// SPDX-License-Identifier: MIT
#include "pipelines/survey/describe.h"

#include "pipelines/survey/observe.h"

namespace sketchsplat {

Described describe(const Sketch& sketch, const EdgeWorld& world, const Prices& prices) {
  const Observation o = observe_places(sketch, world);
  Described out;
  for (int s = 0; s < sketch.size(); ++s)
    out.points.push_back(measure(o, s, world.footprint).point);
  out.cost.footprint = world.footprint;
  out.cost.price = prices.parameter;
  out.cost.sigma_px = place_sigma_px(o, prices.sigma_px);
  out.cost.node_price = node_price(world, out.cost.sigma_px);
  return out;
}

Eigen::Matrix3Xd points_of(const StrokePoints& points, const std::set<int>& strokes) {
  Eigen::Matrix3Xd out(3, 0);
  for (int s : strokes) {
    const Eigen::Index n = out.cols();
    out.conservativeResize(3, n + points[s].cols());
    out.rightCols(points[s].cols()) = points[s];
  }
  return out;
}

}  // namespace sketchsplat
