// SPDX-License-Identifier: MIT
#include "pipelines/candidates/level_rings.h"

#include <cmath>

#include "datasets/types/median.h"
#include "datasets/types/parallel.h"
#include "datasets/types/widest_gap.h"
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

// What most views agree on, again and again without these.
void add_agreed(std::vector<Ring> rings, const Level& level, double reach, int fewest_views,
                std::vector<Candidate>* out) {
  while (true) {
    std::vector<size_t> best;
    int most = 0;
    for (const Ring& ring : rings) {
      std::vector<size_t> like;
      int views = 0;
      for (size_t k = 0; k < rings.size(); ++k) {
        if (!agree(ring, rings[k], reach)) continue;
        views += like.empty() || rings[like.back()].view != rings[k].view;  // in order of views
        like.push_back(k);
      }
      if (views > most) most = views, best = like;
    }
    if (most < fewest_views) return;
    Candidate c{StrokeKind::kCircle, {}};
    std::vector<double> value[4];
    for (const size_t k : best) {
      for (int d = 0; d < 3; ++d) value[d].push_back(rings[k].centre[d]);
      value[3].push_back(rings[k].radius);
    }
    c.curve.count = 2;
    for (int d = 0; d < 3; ++d) c.curve.p[0][d] = median(value[d]);
    c.curve.p[1] = median(value[3]) * level.normal();
    out->push_back(c);
    for (size_t k = best.size(); k-- > 0;) rings.erase(rings.begin() + std::ptrdiff_t(best[k]));
  }
}

}  // namespace

std::vector<Candidate> level_rings(const std::vector<Levels>& levels, const EdgeWorld& world,
                                   const EdgelFlags& explained, int fewest_views) {
  std::vector<std::vector<Chain>> chains;
  for (size_t v = 0; v < world.maps.size(); ++v)
    chains.push_back(free_chains(world.maps[v], explained[v]));
  std::vector<Level> all;
  for (const Levels& l : levels) {
    const std::vector<char> main = main_levels(l);
    for (size_t k = 0; k < l.height.size(); ++k)
      if (main[k]) all.emplace_back(l.normal, -l.height[k]);
  }
  std::vector<std::vector<Candidate>> found(all.size());
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
      add_agreed(std::move(rings), all[k], kSamePx * world.footprint, fewest_views, &found[k]);
  });
  std::vector<Candidate> out;
  for (const std::vector<Candidate>& f : found) out.insert(out.end(), f.begin(), f.end());
  return out;
}

}  // namespace sketchsplat
