// SPDX-License-Identifier: MIT
#include "edges/image/edgel_map.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace sketchsplat {

std::vector<int> append_runs(const EdgelMap& from, const std::vector<char>& keep, int min_chain,
                             EdgelMap* to) {
  std::vector<int> kept;
  const bool judged = !from.meaning.empty() && int(to->meaning.size()) == to->num_chains();
  if (to->chain.empty()) to->chain.push_back(int(to->edgels.size()));
  to->nearest.clear();
  to->window_width = to->window_height = 0;
  for (int c = 0; c < from.num_chains(); ++c)
    for (int begin = from.chain[c], end; begin < from.chain[c + 1]; begin = end + 1) {
      for (end = begin; end < from.chain[c + 1] && keep[end];) ++end;
      if (end == begin || end - begin < min_chain) continue;
      for (int k = begin; k < end; ++k) kept.push_back(k), to->edgels.push_back(from.edgels[k]);
      to->chain.push_back(int(to->edgels.size()));
      if (judged)
        to->meaning.push_back(from.meaning[c]);
      else
        to->meaning.clear();
    }
  return kept;
}

EdgelMap runs_of(const EdgelMap& map, const std::vector<char>& keep, int min_chain,
                 std::vector<int>* where) {
  EdgelMap out;
  out.width = map.width, out.height = map.height;
  out.noise = map.noise, out.blur = map.blur;
  out.grey = map.grey;
  std::vector<int> kept = append_runs(map, keep, min_chain, &out);
  if (where) *where = std::move(kept);
  return out;
}

namespace {

// Chessboard distance to the nearest pixel with an edgel, negative, where there is none.
void fill_distances(EdgelMap* map) {
  const cv::Mat1i nearest(map->window_height, map->window_width, map->nearest.data());
  cv::Mat1f distance;
  cv::distanceTransform(nearest < 0, distance, cv::DIST_C, cv::DIST_MASK_3);
  const float* far = distance.ptr<float>();
  for (int& here : map->nearest) {
    if (here < 0) here = -int(*far);
    ++far;
  }
}

}  // namespace

void find_nearest(EdgelMap* map, double reach_px) {
  map->nearest.clear();
  map->window_width = map->window_height = 0;
  if (map->edgels.empty()) return;
  float x_min = 1e9f, y_min = 1e9f, x_max = -1e9f, y_max = -1e9f;
  for (const Edgel& e : map->edgels) {
    x_min = std::min(x_min, e.x), x_max = std::max(x_max, e.x);
    y_min = std::min(y_min, e.y), y_max = std::max(y_max, e.y);
  }
  const int r = int(std::ceil(reach_px));
  map->x0 = int(std::floor(x_min)) - r, map->y0 = int(std::floor(y_min)) - r;
  map->window_width = int(std::ceil(x_max)) + r + 1 - map->x0;
  map->window_height = int(std::ceil(y_max)) + r + 1 - map->y0;
  map->nearest.assign(size_t(map->window_width) * map->window_height, -1);
  std::vector<float> best(map->nearest.size(), float(reach_px * reach_px));
  const int side = 2 * r + 1;  // of the square about an edgel, which the window holds
  std::vector<float> across(side);
  for (int i = 0; i < int(map->edgels.size()); ++i) {
    const Edgel& e = map->edgels[i];
    const int left = int(std::lround(e.x)) - r, top = int(std::lround(e.y)) - r;
    for (int k = 0; k < side; ++k) across[k] = (left + k - e.x) * (left + k - e.x);
    for (int y = top; y < top + side; ++y) {
      const float down = (y - e.y) * (y - e.y);
      const size_t first = size_t(y - map->y0) * map->window_width + (left - map->x0);
      float* least = best.data() + first;
      int* nearest = map->nearest.data() + first;
      for (int k = 0; k < side; ++k) {  // without branches: the compiler makes vectors of it
        const float d = across[k] + down;
        const bool nearer = d < least[k];
        least[k] = nearer ? d : least[k];
        nearest[k] = nearer ? i : nearest[k];
      }
    }
  }
}

void build_lookup(EdgelMap* map, double reach_px) {
  find_nearest(map, reach_px);
  if (!map->edgels.empty()) fill_distances(map);
}

}  // namespace sketchsplat
