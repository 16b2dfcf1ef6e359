// SPDX-License-Identifier: MIT
#include "raster/splats/loss.h"

#include <algorithm>

namespace sketchsplat {
namespace {

float clamp_edge(float value) { return value > 0 ? std::min(value, 1.0f) : 0.0f; }

Tile cut_tile(const Image<float>& edges, int tx, int ty) {
  Tile tile;
  for (int k = 0; k < Tile::kPixels; ++k) {
    const int x = tx * Tile::kSide + k % Tile::kSide, y = ty * Tile::kSide + k / Tile::kSide;
    const bool inside = x < edges.width && y < edges.height;
    tile.value[k] = inside ? clamp_edge(edges.at(x, y)) : -1.0f;
  }
  return tile;
}

}  // namespace

EdgeTarget make_edge_target(const Image<float>& edges) {
  EdgeTarget target;
  target.width = edges.width;
  target.height = edges.height;
  target.tiles_x = (edges.width + Tile::kSide - 1) / Tile::kSide;
  target.tiles_y = (edges.height + Tile::kSide - 1) / Tile::kSide;
  target.tiles.push_back(Tile{});
  for (int ty = 0; ty < target.tiles_y; ++ty) {
    for (int tx = 0; tx < target.tiles_x; ++tx) {
      const Tile tile = cut_tile(edges, tx, ty);
      const bool blank =
          std::all_of(tile.value, tile.value + Tile::kPixels, [](float v) { return v == 0; });
      target.tile_index.push_back(blank ? 0 : int(target.tiles.size()));
      if (!blank) target.tiles.push_back(tile);
    }
  }
  for (const Tile& tile : target.tiles)
    for (const float value : tile.value)
      if (value > 0) target.empty_loss += double(value) * value / 2;
  return target;
}

}  // namespace sketchsplat
