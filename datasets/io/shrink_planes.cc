// SPDX-License-Identifier: MIT
#include "datasets/io/shrink_planes.h"

#include <algorithm>

namespace sketchsplat {
namespace {

/// Mean over blocks.
std::vector<float> block_means(const std::vector<float>& plane, int width, int height, int d) {
  const int w = (width + d - 1) / d, h = (height + d - 1) / d;
  std::vector<float> out(size_t(w) * h);
  for (int y = 0; y < height; ++y) {
    const float* row = &plane[size_t(y) * width];
    float* sums = &out[size_t(y / d) * w];
    for (int i = 0; i < w; ++i) {
      float sum = sums[i];
      for (int x = i * d; x < std::min(width, (i + 1) * d); ++x) sum += row[x];
      sums[i] = sum;
    }
  }
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const int rows = std::min(d, height - y * d), columns = std::min(d, width - x * d);
      out[size_t(y) * w + x] /= float(rows * columns);
    }
  return out;
}

}  // namespace

void shrink_planes(int denominator, Planes* planes) {
  if (denominator <= 1) return;
  const int width = planes->width, height = planes->height;
  const bool has_alpha = planes->channels % 2 == 0;
  const int colours = planes->channels - has_alpha;
  std::vector<float>& alpha = planes->plane[colours];  // of use if has_alpha alone
  for (int c = 0; c < colours; ++c) {
    std::vector<float>& plane = planes->plane[c];
    for (size_t i = 0; has_alpha && i < plane.size(); ++i) plane[i] *= alpha[i];
    plane = block_means(plane, width, height, denominator);
  }
  if (has_alpha) alpha = block_means(alpha, width, height, denominator);
  for (int c = 0; c < colours && has_alpha; ++c)
    for (size_t i = 0; i < alpha.size(); ++i)
      if (alpha[i] > 0) planes->plane[c][i] /= alpha[i];
  planes->width = (width + denominator - 1) / denominator;
  planes->height = (height + denominator - 1) / denominator;
}

}  // namespace sketchsplat
