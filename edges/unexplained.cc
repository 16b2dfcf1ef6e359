// SPDX-License-Identifier: MIT
#include "edges/unexplained.h"

#include <algorithm>
#include <cmath>

namespace sketchsplat {
namespace {

constexpr int kBeside = 2;         // edgels of a chain beside the one that a sample finds
constexpr double kLookupPx = 4.0;  // as the detectors'

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

// Runs of edgels that are not flagged, and where they were.
EdgelMap rest_of(const EdgelMap& map, const std::vector<char>& gone, int min_chain,
                 std::vector<int>* kept) {
  EdgelMap out;
  out.width = map.width, out.height = map.height;
  out.noise = map.noise;
  out.chain.push_back(0);
  for (int c = 0; c < map.num_chains(); ++c)
    for (int begin = map.chain[c], end; begin < map.chain[c + 1]; begin = end + 1) {
      for (end = begin; end < map.chain[c + 1] && !gone[end];) ++end;
      if (end - begin < min_chain) continue;
      for (int k = begin; k < end; ++k) kept->push_back(k), out.edgels.push_back(map.edgels[k]);
      out.chain.push_back(int(out.edgels.size()));
    }
  build_lookup(&out, kLookupPx);
  return out;
}

}  // namespace

EdgelFlags no_edgels(const EdgeWorld& world) {
  EdgelFlags out;
  for (const EdgelMap& m : world.maps) out.emplace_back(m.edgels.size(), 0);
  return out;
}

void explain(const EdgeWorld& world, const CurvePoints& samples, const ExplainOptions& options,
             EdgelFlags* explained) {
#pragma omp parallel for schedule(dynamic, 1)
  for (int v = 0; v < int(world.views.size()); ++v)
    explain_in_view(world, v, samples, options, &(*explained)[v]);
}

EdgeWorld unexplained(const EdgeWorld& world, const EdgelFlags& explained, int min_chain) {
  const int n = int(world.views.size());
  EdgeWorld out;
  out.views = world.views;
  out.bounds = world.bounds;
  out.footprint = world.footprint;
  out.hull = world.hull;
  out.maps.resize(n);
  out.plane_normal.resize(n);
#pragma omp parallel for schedule(dynamic, 1)
  for (int v = 0; v < n; ++v) {
    std::vector<int> kept;
    out.maps[v] = rest_of(world.maps[v], explained[v], min_chain, &kept);
    out.plane_normal[v].resize(3, kept.size());
    for (size_t k = 0; k < kept.size(); ++k)
      out.plane_normal[v].col(k) = world.plane_normal[v].col(kept[k]);
  }
  return out;
}

}  // namespace sketchsplat
