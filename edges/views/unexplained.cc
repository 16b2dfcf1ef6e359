// SPDX-License-Identifier: MIT
#include "edges/views/unexplained.h"

#include <algorithm>
#include <cmath>

#include "datasets/types/parallel.h"
#include "edges/image/edgel_map.h"

namespace sketchsplat {
namespace {

constexpr int kBeside = 2;  // edgels of a chain beside the one that a sample finds

}  // namespace

void explain_in_view(const EdgeWorld& world, int view, const CurvePoints& samples,
                     const ExplainOptions& options, std::vector<char>* explained) {
  const View& v = world.views[view];
  const EdgelMap& map = world.maps[view];
  const double max_sine = std::sin(options.angle_deg * M_PI / 180);
  const int last = int(map.edgels.size()) - 1;
  for (int i = 0; i < samples.position.cols(); ++i) {
    double depth;
    const Eigen::Vector2d p = v.project(samples.position.col(i), &depth);
    if (!(depth > 0)) continue;
    const int k = map.nearest_at(p.x(), p.y());
    if (k < 0) continue;
    for (int j = std::max(0, k - kBeside); j <= std::min(last, k + kBeside); ++j) {
      const Edgel& e = map.edgels[j];
      const double x = p.x() - e.x, y = p.y() - e.y;
      const Eigen::Vector3d n = world.plane_normal[view].col(j).cast<double>();
      if (std::abs(x * e.nx + y * e.ny) <= options.reach_px &&
          std::hypot(x, y) <= options.reach_px + kBeside &&
          std::abs(n.dot(samples.tangent.col(i))) <= max_sine)
        (*explained)[j] = 1;
    }
  }
}

EdgelFlags no_edgels(const EdgeWorld& world) {
  EdgelFlags out;
  for (const EdgelMap& m : world.maps) out.emplace_back(m.edgels.size(), 0);
  return out;
}

void explain(const EdgeWorld& world, const CurvePoints& samples, const ExplainOptions& options,
             EdgelFlags* explained) {
  parallel_for(int(world.views.size()), 1,
               [&](int v) { explain_in_view(world, v, samples, options, &(*explained)[v]); });
}

EdgeWorld unexplained(const EdgeWorld& world, const EdgelFlags& explained, int min_chain) {
  const int n = int(world.views.size());
  EdgeWorld out;
  out.views = world.views;
  out.bounds = world.bounds;
  out.object = world.object;
  out.footprint = world.footprint;
  out.hull = world.hull;
  out.maps.resize(n);
  out.plane_normal.resize(n);
  parallel_for(n, 1, [&](int v) {
    std::vector<char> keep = explained[v];
    for (char& k : keep) k = !k;
    std::vector<int> kept;
    out.maps[v] = runs_of(world.maps[v], keep, min_chain, &kept);
    build_lookup(&out.maps[v]);
    out.plane_normal[v].resize(3, kept.size());
    for (size_t k = 0; k < kept.size(); ++k)
      out.plane_normal[v].col(k) = world.plane_normal[v].col(kept[k]);
  });
  return out;
}

}  // namespace sketchsplat
