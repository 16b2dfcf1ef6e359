// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "raster/splats/lanes.h"
#include "raster/surfels/surfel_footprint.h"

namespace sketchsplat {

/// A tile that surfels touch, Tile::kSide pixels squared, and which of its pixels are wanted.
struct SurfelTile {
  int tx = 0, ty = 0;      ///< column and row of tiles
  int begin = 0, end = 0;  ///< its entries
  std::uint64_t mask = 0;  ///< bit y * kSide + x
};

/// Footprints (front to back) sorted into tiles. Entry e puts footprint entries[e] into a tile; the
/// entries of a tile are front to back, too. Those of footprint f are slots[first_slot[f]] ..
/// slots[first_slot[f + 1] - 1].
struct SurfelBins {
  std::vector<SurfelTile> tiles;
  std::vector<int> entries, first_slot, slots;
};

/// `mask`: see SurfelRenderer::forward. Tiles without footprints are left out.
SurfelBins bin_surfels(const std::vector<SurfelFootprint>& footprints, const Camera& camera,
                       const Image<std::uint8_t>& mask, const SurfelOptions& options);

/// Sums over the surfels of a tile, pixel by pixel; m = z - origin, which keeps floats accurate.
struct alignas(64) SurfelSums {
  Lanes alpha[kLanes], color[3][kLanes], normal[3][kLanes];
  Lanes m[kLanes];       ///< sum w m
  Lanes median[kLanes];  ///< depth
  float origin;
};

/// What backward wants of the images of a tile: the gradients by them, 0 where there is none.
struct alignas(64) SurfelTileGradient {
  Lanes alpha[kLanes], color[3][kLanes], normal[3][kLanes];
  Lanes depth[kLanes], median[kLanes];
};

/// Sums over the pixels of one entry. Names as in SurfelFootprintGradient.
struct SurfelEntryGradient {
  enum Term {
    kU,
    kUx,
    kUy,
    kV,
    kVx,
    kVy,
    kW,
    kWx,
    kWy,  // by u' w, v' w, w: times 1, dx, dy
    kMeanX,
    kMeanY,
    kDepth,
    kOpacity,
    kSkewU,
    kSkewV,
    kColor0,
    kColor1,
    kColor2,
    kNormal0,
    kNormal1,
    kNormal2,
    kAbsX,
    kAbsY,
    kSplitUU,
    kSplitUV,
    kSplitVV,
    kWeight,
    kTerms
  };
  float sum[kTerms];
};

/// The options in the units of the inner loops.
struct SurfelLoop {
  Profile profile;
  bool skewed;
  float lowpass;  ///< |d|^2 times this is q2 log2(e) / 2
  float max_alpha, min_transmittance;
  explicit SurfelLoop(const SurfelOptions& options);
};

/// Composites a tile.
void composite_tile(const SurfelLoop& loop, const SurfelTile& tile, const int* entries,
                    const SurfelFootprint* footprints, SurfelSums* sums);

/// Gradients of all entries of a tile, in their order from `gradients` on.
void composite_tile_backward(const SurfelLoop& loop, const SurfelTile& tile, const int* entries,
                             const SurfelFootprint* footprints, const SurfelSums& sums,
                             const SurfelTileGradient& by_images, SurfelEntryGradient* gradients);

/// Weights w of all pixels of all entries, kPixels per entry.
void tile_weights(const SurfelLoop& loop, const SurfelTile& tile, const int* entries,
                  const SurfelFootprint* footprints, float* weights);

/// 2 Phi(s) for |s| <= 13, absolute error below 6e-7, and exactly 1 at 0; `density`: phi(s).
void twice_normal_cdf(const float* s, int count, float* value, float* density);

}  // namespace sketchsplat
