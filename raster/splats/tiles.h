// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "raster/splats/loss.h"
#include "raster/splats/project.h"

namespace sketchsplat {

/// The part of a footprint in one tile: whole rows of it.
struct TilePatch {
  int slot;      ///< which of TouchedTiles::tiles
  int row;       ///< first row in the tile
  int rows;      ///< number of rows
  float dx, dy;  ///< [px] from the footprint's mean to column 0 of that first row
};

/// The tiles of an image that splats touch, and one value per pixel of them.
struct TouchedTiles {
  int tiles_x = 0, tiles_y = 0;
  std::vector<int> slot;     ///< tiles_x * tiles_y: index into tiles, or -1
  std::vector<int> touched;  ///< which tile tiles[s] is, ty * tiles_x + tx
  std::vector<Tile> tiles;
  std::vector<TilePatch> patches;  ///< of footprint i: first_patch[i] .. first_patch[i + 1] - 1
  std::vector<int> first_patch;
};

/// All tiles under the footprints, in order of first touch, filled with the optical depth
/// sum_i tau_i (summed in the order of the footprints).
TouchedTiles accumulate_depth(const Camera& camera, const std::vector<Footprint>& footprints,
                              const RasterOptions& options);

/// Optical depth to grey value 1 - exp(-tau), in place.
void expose(TouchedTiles* tiles);

/// Loss of the picture that has these optical depths, and 0 where no tile is. The optical depths
/// are replaced by the derivatives of the loss by them.
double compare(const EdgeTarget& target, TouchedTiles* by_depth);

/// Gradient by the footprints, given that by the optical depths, in tiles made by accumulate_depth
/// from the same footprints.
std::vector<FootprintGradient> gather_gradients(const TouchedTiles& by_depth,
                                                const std::vector<Footprint>& footprints,
                                                const RasterOptions& options);

}  // namespace sketchsplat
