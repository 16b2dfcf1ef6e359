// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <vector>

namespace sketchsplat {

/// One channel, row-major. The centre of the top-left pixel is (0, 0).
template <typename T>
struct Image {
  int width = 0;
  int height = 0;
  std::vector<T> data;  ///< width * height values

  Image() = default;
  Image(int w, int h, T value = T()) : width(w), height(h), data(size_t(w) * h, value) {}

  bool empty() const { return data.empty(); }
  T& at(int x, int y) {
    assert(x >= 0 && x < width && y >= 0 && y < height);
    return data[size_t(y) * width + x];
  }
  const T& at(int x, int y) const {
    assert(x >= 0 && x < width && y >= 0 && y < height);
    return data[size_t(y) * width + x];
  }
  T* row(int y) { return data.data() + size_t(y) * width; }
  const T* row(int y) const { return data.data() + size_t(y) * width; }
};

/// The part whose top-left pixel is (x0, y0). Precondition: it lies inside the image.
template <typename T>
Image<T> cut(const Image<T>& image, int x0, int y0, int width, int height) {
  assert(x0 >= 0 && y0 >= 0 && x0 + width <= image.width && y0 + height <= image.height);
  Image<T> out(width, height);
  for (int y = 0; y < height; ++y) std::copy_n(image.row(y0 + y) + x0, width, out.row(y));
  return out;
}

/// A picture as the detectors want it: RGB in [0, 1], never premultiplied, and its mask.
struct Picture {
  Image<float> red, green, blue;
  Image<float> alpha;    ///< in [0, 1]; empty if the file has no alpha
  double beyond_px = 0;  ///< [px] by which alpha may reach beyond the object that it is of
  int width() const { return red.width; }
  int height() const { return red.height; }
};

}  // namespace sketchsplat
