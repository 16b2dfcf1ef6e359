// SPDX-License-Identifier: MIT
#include "edges/views/recast.h"

#include <array>
#include <memory>
#include <utility>

#include "datasets/types/parallel.h"
#include "edges/image/edgel_map.h"
#include "edges/image/undistort.h"

namespace sketchsplat {
namespace {

// Whether edgels lie where they lay.
bool same_image(const View& a, const View& b) {
  const Camera &p = a.camera, &q = b.camera;
  const Lens::Terms &l = a.lens.terms(), &m = b.lens.terms();
  const auto all = [](const Lens::Terms& t) {
    return std::array<double, 8>{t.k1, t.k2, t.p1, t.p2, t.k3, t.k4, t.k5, t.k6};
  };
  return p.fx == q.fx && p.fy == q.fy && p.cx == q.cx && p.cy == q.cy &&
         a.lens.model() == b.lens.model() && all(l) == all(m);
}

EdgelMap coarser(const EdgelMap& map, int factor) {
  EdgelMap out;
  out.width = (map.width + factor - 1) / factor, out.height = (map.height + factor - 1) / factor;
  out.noise = map.noise;
  out.chain.push_back(0);
  for (int c = 0; c < map.num_chains(); ++c) {
    if (map.chain[c + 1] - map.chain[c] < kShortestRun * factor) continue;
    for (int i = map.chain[c] + factor / 2; i < map.chain[c + 1]; i += factor) {
      Edgel e = map.edgels[i];
      e.x = (e.x + 0.5f) / float(factor) - 0.5f, e.y = (e.y + 0.5f) / float(factor) - 0.5f;
      e.width /= float(factor), e.strength *= float(factor);
      out.edgels.push_back(e);
    }
    out.chain.push_back(int(out.edgels.size()));
    if (!map.meaning.empty()) out.meaning.push_back(map.meaning[c]);
  }
  build_lookup(&out);
  return out;
}

}  // namespace

EdgeWorld recast(EdgeWorld world, std::vector<View> views) {
  const int n = int(world.views.size());
  parallel_for(n, 1, [&](int v) {
    const View& from = world.views[v];
    EdgelMap& map = world.maps[v];
    const bool lens = !from.lens.is_identity() || !views[v].lens.is_identity();
    if (lens && !same_image(from, views[v])) {
      map = undistort_edgels(distort_edgels(std::move(map), from), views[v], 1);
      build_lookup(&map);
    }
    world.plane_normal[v] = plane_normals(views[v], map);
  });
  world.views = std::move(views);
  return world;
}

EdgeWorld without_views(const EdgeWorld& world, const std::vector<char>& leave) {
  EdgeWorld out = world;
  out.views.clear(), out.maps.clear(), out.plane_normal.clear();
  std::vector<Image<uint8_t>> silhouettes;
  for (size_t v = 0; v < leave.size(); ++v) {
    if (leave[v]) continue;
    if (world.silhouettes) silhouettes.push_back((*world.silhouettes)[v]);
    out.views.push_back(world.views[v]);
    out.maps.push_back(world.maps[v]);
    out.plane_normal.push_back(world.plane_normal[v]);
  }
  if (world.silhouettes)
    out.silhouettes = std::make_shared<const std::vector<Image<uint8_t>>>(std::move(silhouettes));
  return out;
}

EdgeWorld coarser(const EdgeWorld& world, int factor) {
  const int n = int(world.views.size());
  EdgeWorld out;
  out.views = world.views;
  out.bounds = world.bounds;
  out.footprint = world.footprint * factor;
  out.hull = world.hull;
  out.maps.resize(n);
  out.plane_normal.resize(n);
  parallel_for(n, 1, [&](int v) {
    out.views[v].camera = world.views[v].camera.shrunk(factor);
    out.maps[v] = coarser(world.maps[v], factor);
    out.plane_normal[v] = plane_normals(out.views[v], out.maps[v]);
  });
  return out;
}

}  // namespace sketchsplat
