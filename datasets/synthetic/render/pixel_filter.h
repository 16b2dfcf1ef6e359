// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace sketchsplat {

/// Blackman-Harris window over three pixels, by the distance from the pixel's centre [px]; 1 in the
/// middle (Harris, "On the use of windows for harmonic analysis", 1978). From a table: it is asked
/// for tens of millions of times.
class PixelFilter {
 public:
  PixelFilter() {
    for (int i = 0; i <= kSteps; ++i) {
      const double t = 2 * M_PI * (0.5 + 0.5 * i / kSteps);
      table_[i] = float(0.35875 - 0.48829 * std::cos(t) + 0.14128 * std::cos(2 * t) -
                        0.01168 * std::cos(3 * t));
    }
    table_[kSteps + 1] = table_[kSteps];
  }
  float operator()(float x) const {
    const float at = std::min(std::abs(x) / 1.5f, 1.0f) * kSteps;
    const int i = int(at);
    return table_[i] + (at - i) * (table_[i + 1] - table_[i]);
  }

 private:
  static constexpr int kSteps = 512;
  std::array<float, kSteps + 2> table_;
};
inline const PixelFilter pixel_filter;

/// What a ray at (dx, dy) from the centre of its pixel counts in the pixel itself (the fifth) and
/// in its neighbours, row by row.
inline std::array<float, 9> weights_of_a_ray(float dx, float dy) {
  const float wx[3] = {pixel_filter(dx + 1), pixel_filter(dx), pixel_filter(dx - 1)};
  const float wy[3] = {pixel_filter(dy + 1), pixel_filter(dy), pixel_filter(dy - 1)};
  std::array<float, 9> weights;
  for (int k = 0; k < 9; ++k) weights[k] = wx[k % 3] * wy[k / 3];
  return weights;
}

/// The sums of these over `grid` times `grid` rays: of a pixel where nothing changes.
inline std::array<float, 9> weights_of_a_grid(int grid) {
  std::array<float, 9> sums{};
  for (int i = 0; i < grid * grid; ++i) {
    const std::array<float, 9> weights =
        weights_of_a_ray((float(i % grid) + 0.5f) / float(grid) - 0.5f,
                         (float(i / grid) + 0.5f) / float(grid) - 0.5f);
    for (int k = 0; k < 9; ++k) sums[k] += weights[k];
  }
  return sums;
}

}  // namespace sketchsplat
