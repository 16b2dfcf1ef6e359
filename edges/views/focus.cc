// SPDX-License-Identifier: MIT
#include "edges/views/focus.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "datasets/types/parallel.h"
#include "edges/image/edgel_map.h"

namespace sketchsplat {
namespace {

// Does every corner of the region's box lie in front of the camera? Then a pixel is inside if a
// point of the box is seen there: the pixel box of its corners, for simplicity.
bool pixel_box(const View& view, const Eigen::AlignedBox3d& box, Eigen::AlignedBox2d* out) {
  for (int k = 0; k < 8; ++k) {
    double depth;
    const Eigen::Vector2d p = view.project(box.corner(Eigen::AlignedBox3d::CornerType(k)), &depth);
    if (!(depth > 0)) return false;
    out->extend(p);
  }
  return true;
}

EdgelMap kept(const EdgelMap& map, const std::vector<char>& keep) {
  EdgelMap out = runs_of(map, keep, kShortestRun);
  out.mask = map.mask;
  return out;
}

}  // namespace

EdgelMap most_meaningful(const EdgelMap& map, double most_edgels) {
  if (map.meaning.empty() || double(map.edgels.size()) <= most_edgels) return map;
  std::vector<int> order(map.num_chains());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return map.meaning[a] > map.meaning[b]; });
  std::vector<char> keep(map.edgels.size(), 0);
  double edgels = 0;
  for (const int c : order) {
    edgels += map.chain[c + 1] - map.chain[c];
    if (edgels > most_edgels) break;
    std::fill(keep.begin() + map.chain[c], keep.begin() + map.chain[c + 1], 1);
  }
  return kept(map, keep);
}

EdgeWorld focused(EdgeWorld world, const ObjectRegion& object, double most_sides) {
  std::vector<EdgelMap> maps(world.maps.size());
  parallel_for(int(maps.size()), 1, [&](int v) {
    const EdgelMap& map = world.maps[v];
    Eigen::AlignedBox2d box;
    maps[v] = map;
    if (!object.box.isEmpty() && pixel_box(world.views[v], object.box, &box)) {
      std::vector<char> inside(map.edgels.size());
      for (size_t i = 0; i < inside.size(); ++i)
        inside[i] = box.contains(Eigen::Vector2d(map.edgels[i].x, map.edgels[i].y));
      maps[v] = kept(map, inside);
    }
    if (most_sides > 0)
      maps[v] = most_meaningful(maps[v], most_sides * std::sqrt(double(map.width) * map.height));
  });
  EdgeWorld out = make_edge_world(std::move(world.views), std::move(maps));
  if (object.box.isEmpty()) return out;
  out.bounds = object.box;
  out.object = object;
  return out;
}

}  // namespace sketchsplat
