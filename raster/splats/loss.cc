// SPDX-License-Identifier: MIT
#include "raster/splats/loss.h"

#include <algorithm>
#include <cmath>

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

double pixel_loss(double value, double edge, const LossOptions& options, double* by_value) {
  const double w =
      options.background_weight + (options.edge_weight - options.background_weight) * edge;
  const double r = value - edge;
  if (options.kind == LossKind::kSquared) {
    if (by_value) *by_value = w * r;
    return w * r * r / 2;
  }
  const double root = std::hypot(r, options.softness);
  if (by_value) *by_value = w * r / root;
  return w * (root - options.softness);
}

double background_per_edge(const Image<float>& edges) {
  double edge = 0;
  for (const float value : edges.data) edge += clamp_edge(value);
  return edge > 0 ? (double(edges.data.size()) - edge) / edge : 1.0;
}

EdgeTarget make_edge_target(const Image<float>& edges, const LossOptions& options) {
  EdgeTarget target;
  target.width = edges.width;
  target.height = edges.height;
  target.tiles_x = (edges.width + Tile::kSide - 1) / Tile::kSide;
  target.tiles_y = (edges.height + Tile::kSide - 1) / Tile::kSide;
  target.options = options;
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
  for (const Tile& tile : target.tiles) {
    for (const float value : tile.value) {
      if (value > 0) target.empty_loss += pixel_loss(0, value, options);
    }
  }
  return target;
}

}  // namespace sketchsplat
