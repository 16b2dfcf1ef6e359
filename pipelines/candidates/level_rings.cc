// SPDX-License-Identifier: MIT
#include <cmath>

#include "datasets/types/median.h"
#include "datasets/types/parallel.h"
#include "datasets/types/widest_gap.h"
#include "pipelines/candidates/generators.h"
#include "sketches/fit/fit.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr int kFewestEdgels = 8;
constexpr double kFreeShare = 0.7;    // of a chain that nothing else explains
constexpr double kFrontal = 0.25;     // cosine of the line of sight and the normal, at least
constexpr double kRoundPx = 0.8;      // [px] rms distance in the picture from a circle in the plane
constexpr double kMostGap = 2.6;      // [rad] of the circle without an edgel
constexpr double kLeastRadiusPx = 2;  // [footprints]
constexpr double kMostRadiusPx = 40;  // [footprints]: larger ones are matched as others are
constexpr double kSamePx = 1.5;       // [footprints] of centres and radii of one circle
constexpr size_t kMostRings = 2000;   // in one level; a texture of rings tells nothing

using Level = Eigen::Hyperplane<double, 3>;

struct Ring {
  int view;
  Vector3d centre;
  double radius;
};

using Chain = std::vector<Eigen::Vector2d>;  // ideal pixels

std::vector<Chain> free_chains(const EdgelMap& map, const std::vector<char>& explained) {
  std::vector<Chain> out;
  for (size_t c = 0; c + 1 < map.chain.size(); ++c) {
    Chain chain;
    for (int i = map.chain[c]; i < map.chain[c + 1]; ++i)
      if (!explained[i]) chain.push_back({map.edgels[i].x, map.edgels[i].y});
    const int all = map.chain[c + 1] - map.chain[c];
    if (int(chain.size()) >= kFewestEdgels && double(chain.size()) >= kFreeShare * all)
      out.push_back(chain);
  }
  return out;
}

// The circle in the plane whose picture a chain is.
bool ring_of(const Chain& chain, const View& view, const Level& level, double footprint,
             Ring* out) {
  const Eigen::Matrix3d world_from_cam = view.cam_from_world.rotation.transpose();
  const Vector3d camera = view.center_in_world();
  Matrix3Xd points(3, Eigen::Index(chain.size()));
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::ParametrizedLine<double, 3> ray(camera,
                                                 world_from_cam * view.camera.ray(chain[i]));
    const double depth = ray.intersectionParameter(level);
    if (!(depth > 0)) return false;
    points.col(i) = ray.pointAt(depth);
  }
  const Vector3d middle = points.rowwise().mean();
  const double frontal = std::abs((middle - camera).normalized().dot(level.normal()));
  const double size = (points.colwise() - middle).colwise().norm().maxCoeff();
  if (frontal < kFrontal || size > 2 * kMostRadiusPx * footprint) return false;
  const CircleFit fit = fit_circle(points);
  if (!fit.success || fit.radius < kLeastRadiusPx * footprint ||
      fit.radius > kMostRadiusPx * footprint || fit.rms * frontal > kRoundPx * footprint ||
      widest_gap(points.colwise() - fit.centre, level.normal()) > kMostGap)
    return false;
  *out = {0, fit.centre, fit.radius};
  return true;
}

bool agree(const Ring& a, const Ring& b, double reach) {
  return std::abs(a.radius - b.radius) < reach && (a.centre - b.centre).norm() < reach;
}

// Of each ring those that agree with it, itself too, in order of views.
std::vector<std::vector<int>> agreeing(const std::vector<Ring>& rings, double reach) {
  std::vector<std::vector<int>> out(rings.size());
  for (size_t i = 0; i < rings.size(); ++i)
    for (size_t k = 0; k < rings.size(); ++k)
      if (agree(rings[i], rings[k], reach)) out[i].push_back(int(k));
  return out;
}

LevelRing median_ring(const std::vector<Ring>& rings, const std::vector<int>& of, int views,
                      const Vector3d& normal) {
  std::vector<double> value[4];
  for (const int k : of) {
    for (int d = 0; d < 3; ++d) value[d].push_back(rings[k].centre[d]);
    value[3].push_back(rings[k].radius);
  }
  LevelRing out;
  out.views = views;
  out.ring.kind = StrokeKind::kCircle;
  out.ring.curve.count = 2;
  for (int d = 0; d < 3; ++d) out.ring.curve.p[0][d] = median(value[d]);
  out.ring.curve.p[1] = median(value[3]) * normal;
  return out;
}

// What most views agree on, again and again without these.
std::vector<LevelRing> agreed(const std::vector<Ring>& rings, const Vector3d& normal,
                              double reach) {
  const std::vector<std::vector<int>> agreeing_with = agreeing(rings, reach);
  std::vector<char> gone(rings.size(), 0);
  std::vector<LevelRing> out;
  while (true) {
    std::vector<int> best;
    int most = 0;
    for (size_t i = 0; i < rings.size(); ++i) {
      if (gone[i]) continue;
      std::vector<int> like;
      int views = 0;
      for (const int k : agreeing_with[i]) {
        if (gone[k]) continue;
        views += like.empty() || rings[like.back()].view != rings[k].view;
        like.push_back(k);
      }
      if (views > most) most = views, best = like;
    }
    if (most == 0) return out;
    out.push_back(median_ring(rings, best, most, normal));
    for (const int k : best) gone[k] = 1;
  }
}

}  // namespace

std::vector<LevelRing> level_rings(const std::vector<Levels>& levels, const EdgeWorld& world,
                                   const EdgelFlags& explained, size_t most) {
  std::vector<std::vector<Chain>> chains;
  for (size_t v = 0; v < world.maps.size(); ++v)
    chains.push_back(free_chains(world.maps[v], explained[v]));
  std::vector<Level> all;
  for (const Levels& l : levels) {
    const std::vector<char> main = main_levels(l);
    for (size_t k = 0; k < l.height.size(); ++k)
      if (main[k]) all.emplace_back(l.normal, -l.height[k]);
  }
  std::vector<std::vector<LevelRing>> found(all.size());
  parallel_for(int(all.size()), 1, [&](int k) {
    std::vector<Ring> rings;
    Ring ring;
    for (size_t v = 0; v < chains.size(); ++v)
      for (const Chain& chain : chains[v])
        if (ring_of(chain, world.views[v], all[k], world.footprint, &ring)) {
          ring.view = int(v);
          rings.push_back(ring);
        }
    if (rings.size() <= kMostRings)
      found[k] = agreed(rings, all[k].normal(), kSamePx * world.footprint);
  });
  std::vector<LevelRing> out;
  for (const std::vector<LevelRing>& f : found) out.insert(out.end(), f.begin(), f.end());
  if (out.size() > most) out.clear();
  return out;
}

}  // namespace sketchsplat
