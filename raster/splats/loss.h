// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "datasets/types/image.h"

namespace sketchsplat {

enum class LossKind {
  kSquared,      ///< rho(r) = r^2 / 2
  kCharbonnier,  ///< rho(r) = sqrt(r^2 + softness^2) - softness: L1 with a smooth bottom
};

/// The loss of an image I against edges E is the sum over all pixels of w(E) rho(I - E), with
/// w(E) = background_weight + (edge_weight - background_weight) E. Nothing is sampled.
struct LossOptions {
  LossKind kind = LossKind::kCharbonnier;
  double softness = 0.05;          ///< of kCharbonnier, in grey values, > 0
  double edge_weight = 1.0;        ///< >= 0
  double background_weight = 1.0;  ///< >= 0
};

/// Loss of one pixel and, if `by_value` is there, its derivative by `value`.
double pixel_loss(double value, double edge, const LossOptions& options,
                  double* by_value = nullptr);

/// Sum of 1 - E over sum of E: as edge_weight (background_weight 1), edges and background weigh the
/// same. 1 if there is no edge at all.
double background_per_edge(const Image<float>& edges);

/// 8 x 8 pixels, row-major.
struct alignas(64) Tile {
  static constexpr int kSide = 8;
  static constexpr int kPixels = kSide * kSide;
  float value[kPixels];
};

/// An edge image made ready for many comparisons: in tiles, where those without an edge share one,
/// with the loss of the empty rendering. A rendering then costs in proportion to the tiles it
/// touches.
struct EdgeTarget {
  int width = 0, height = 0;     ///< [px]
  int tiles_x = 0, tiles_y = 0;  ///< tiles that cover the image
  LossOptions options;
  double empty_loss = 0;        ///< loss of the image that is 0 everywhere
  std::vector<int> tile_index;  ///< tiles_x * tiles_y indices into tiles
  std::vector<Tile> tiles;      ///< values in [0, 1]; -1 outside the image: weight 0
};

/// Values of `edges` are clamped to [0, 1]; a NaN counts as 0.
EdgeTarget make_edge_target(const Image<float>& edges, const LossOptions& options);

}  // namespace sketchsplat
