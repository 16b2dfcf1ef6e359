// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "datasets/types/image.h"

namespace sketchsplat {

/// 8 x 8 pixels, row-major.
struct alignas(64) Tile {
  static constexpr int kSide = 8;
  static constexpr int kPixels = kSide * kSide;
  float value[kPixels];
};

/// An edge image made ready for many comparisons: in tiles, where those without an edge share one,
/// with the loss of the empty rendering. A rendering then costs in proportion to the tiles it
/// touches. The loss of an image I against edges E is half the sum over all pixels of (I - E)^2.
struct EdgeTarget {
  int width = 0, height = 0;     ///< [px]
  int tiles_x = 0, tiles_y = 0;  ///< tiles that cover the image
  double empty_loss = 0;         ///< loss of the image that is 0 everywhere
  std::vector<int> tile_index;   ///< tiles_x * tiles_y indices into tiles
  std::vector<Tile> tiles;       ///< values in [0, 1]; -1 outside the image: weight 0
};

/// Values of `edges` are clamped to [0, 1]; a NaN counts as 0.
EdgeTarget make_edge_target(const Image<float>& edges);

}  // namespace sketchsplat
