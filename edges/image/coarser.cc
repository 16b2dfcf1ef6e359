// SPDX-License-Identifier: MIT
#include "edges/image/coarser.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "datasets/types/median.h"
#include "edges/image/edgel_map.h"
#include "edges/image/edgel_parabola.h"
#include "edges/image/pull_of_blur.h"

namespace sketchsplat {
namespace {

constexpr double kOwn = 1.5;     // [sigmas] about a finer edgel, where a coarser scale sees it, too
constexpr double kReach = 4;     // [sigmas] of a chain to either side that tell how it bends
constexpr int kLeast = 5;        // edgels that tell it
constexpr double kWidest = 1.6;  // times the median of finer scales

// Curvature of a chain about one of its edgels [1 / px], positive if it turns towards the normal:
// that of the parabola through what lies within `reach_px`.
double bend_at(const EdgelMap& map, int chain, int at, double reach_px) {
  EdgelParabola parabola(map.edgels[at], 1);
  const auto add = [&](const Edgel& e) {
    if (parabola.place(e).squaredNorm() > reach_px * reach_px) return false;
    parabola.add(e);
    return true;
  };
  for (int k = at; k < map.chain[chain + 1] && add(map.edgels[k]);) ++k;
  for (int k = at - 1; k >= map.chain[chain] && add(map.edgels[k]);) --k;
  if (parabola.count() < kLeast) return 0;
  const Eigen::Vector3d x = parabola.coefficients();
  return 2 * x[2] / std::pow(1 + x[1] * x[1], 1.5);
}

// Some edgels of a coarser scale as the finest would show them.
void refine(double sigma_px, double finest_px, const std::vector<char>& which, EdgelMap* map) {
  std::vector<double> bend(map->edgels.size());
  for (int c = 0; c < map->num_chains(); ++c)
    for (int i = map->chain[c]; i < map->chain[c + 1]; ++i)
      if (which[i]) bend[i] = bend_at(*map, c, i, kReach * sigma_px);
  const double less = sigma_px * sigma_px - finest_px * finest_px;
  for (size_t i = 0; i < bend.size(); ++i) {
    if (!which[i]) continue;
    Edgel& e = map->edgels[i];
    const double width = e.width;
    const double fine = std::sqrt(std::max(width * width - less, finest_px * finest_px));
    const double curvature = std::abs(bend[i]);
    const double out = pull_of_blur(curvature, width) - pull_of_blur(curvature, fine);
    const float way = float(bend[i] > 0 ? -out : out);
    e.x += way * e.nx, e.y += way * e.ny;
    e.strength *= float(width / fine);
    e.width = float(fine);
  }
}

float median_width(const EdgelMap& map, int begin, int end, const std::vector<char>& keep) {
  std::vector<float> widths;
  for (int i = begin; i < end; ++i)
    if (keep[i]) widths.push_back(map.edgels[i].width);
  return widths.empty() ? 0.f : median(std::move(widths));
}

// Which edgels of a coarser scale no finer one shows.
std::vector<char> new_ones(const EdgelMap& coarse, double sigma_px, EdgelMap* map) {
  const double own = kOwn * sigma_px;
  find_nearest(map, own + 1);
  std::vector<char> out(coarse.edgels.size());
  for (size_t i = 0; i < out.size(); ++i) {
    const Edgel& e = coarse.edgels[i];
    const int k = map->nearest_at(e.x, e.y);
    out[i] = k < 0 || std::hypot(map->edgels[k].x - e.x, map->edgels[k].y - e.y) > own;
  }
  return out;
}

}  // namespace

void add_coarser(EdgelMap coarse, double sigma_px, double finest_px, int min_chain, EdgelMap* map) {
  std::vector<char> keep = new_ones(coarse, sigma_px, map);
  refine(sigma_px, finest_px, keep, &coarse);
  if (map->num_chains() > 0) {
    const std::vector<char> all(map->edgels.size(), 1);
    const float widest = float(kWidest) * median_width(*map, 0, int(all.size()), all);
    for (int c = 0; c < coarse.num_chains(); ++c) {
      const int begin = coarse.chain[c], end = coarse.chain[c + 1];
      if (median_width(coarse, begin, end, keep) > widest)
        std::fill(keep.begin() + begin, keep.begin() + end, 0);
    }
  }
  append_runs(coarse, keep, min_chain, map);
}

}  // namespace sketchsplat
