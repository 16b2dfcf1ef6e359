// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "edges/image/detect.h"

namespace sketchsplat {

/// How far at least the nearest edgel is, by cells of a map's window, which stay in the cache where
/// the look-up by pixel does not.
class FarCells {
 public:
  FarCells() = default;
  /// `map` must outlive it.
  explicit FarCells(const EdgelMap& map)
      : map_(&map),
        columns_((map.window_width + kSide - 1) / kSide),
        least_(size_t(columns_) * ((map.window_height + kSide - 1) / kSide), UINT8_MAX) {
    for (int v = 0; v < map.window_height; ++v)
      for (int u = 0; u < map.window_width; ++u) {
        const int far = -map.nearest[size_t(v) * map.window_width + u] - 1;
        uint8_t& least = least_[size_t(v / kSide) * columns_ + u / kSide];
        least = uint8_t(std::clamp(far, 0, int(least)));
      }
  }

  /// [px] about a pixel within which none holds an edgel; 0: the look-up knows better.
  int least_px(float x, float y) const {
    const float u = x + 0.5f - float(map_->x0), v = y + 0.5f - float(map_->y0);
    if (!(u >= 0 && v >= 0 && u < float(map_->window_width) && v < float(map_->window_height)))
      return 0;
    return least_[size_t(int(v) / kSide) * columns_ + int(u) / kSide];
  }

 private:
  static constexpr int kSide = 4;
  const EdgelMap* map_ = nullptr;
  int columns_ = 0;
  std::vector<uint8_t> least_;
};

}  // namespace sketchsplat
