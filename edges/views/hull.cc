// SPDX-License-Identifier: MIT
#include "edges/views/hull.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "datasets/types/parallel.h"
#include "edges/views/lift.h"

namespace sketchsplat {
namespace {

// Number of mask pixels above and left of each pixel: says at once whether a box touches the mask.
Image<int> integral(const Image<uint8_t>& mask) {
  Image<int> sum(mask.width + 1, mask.height + 1);
  for (int y = 0; y < mask.height; ++y) {
    int row = 0;
    for (int x = 0; x < mask.width; ++x) {
      row += mask.at(x, y);
      sum.at(x + 1, y + 1) = sum.at(x + 1, y) + row;
    }
  }
  return sum;
}

// How much of a box of half size r around (x, y) the mask holds. What leaves the image is not
// judged.
enum Share : uint8_t { kNone, kSome, kAll };
Share share(const Image<int>& sum, double x, double y, double r) {
  const int w = sum.width - 1, h = sum.height - 1;
  if (!(x >= 0 && y >= 0 && x <= w - 1 && y <= h - 1)) return kSome;
  r = std::min(r, double(w + h));  // a box around the camera itself has no bounds
  const int x0 = std::max(0, int(x - r)), x1 = std::min(w, int(x + r) + 2);
  const int y0 = std::max(0, int(y - r)), y1 = std::min(h, int(y + r) + 2);
  const int held = sum.at(x1, y1) - sum.at(x0, y1) - sum.at(x1, y0) + sum.at(x0, y0);
  return held == 0 ? kNone : held == (x1 - x0) * (y1 - y0) ? kAll : kSome;
}

// The same around an ideal pixel; masks are in the pixels of the image.
Share share(const Image<int>& sum, const View& view, const Eigen::Vector2d& ideal, double r) {
  if (view.lens.is_identity()) return share(sum, ideal.x(), ideal.y(), r);
  Eigen::Vector2d image;
  Eigen::Matrix2d J;
  if (!view.image_pixel(ideal, &image, &J)) return kSome;
  // At least what a length can grow by, and hardly more: the spectral norm is no larger.
  const double growth = std::sqrt(J.cwiseAbs().rowwise().sum().maxCoeff() *
                                  J.cwiseAbs().colwise().sum().maxCoeff());
  return share(sum, image.x(), image.y(), r * growth);
}

constexpr double kSurroundings = 2.5;  // cells

}  // namespace

VisualHull::VisualHull(const EdgeWorld& world, int cells) {
  const auto mask_of = [&](size_t v) -> const Image<uint8_t>& {
    const Image<uint8_t>& mask = world.maps[v].mask;
    return mask.empty() && world.silhouettes ? (*world.silhouettes)[v] : mask;
  };
  std::vector<int> masked;
  for (size_t v = 0; v < world.maps.size(); ++v)
    if (!mask_of(v).empty() && !world.maps[v].edgels.empty()) masked.push_back(int(v));
  if (masked.size() < 3 || world.bounds.isEmpty()) return;
  std::vector<Image<int>> sums(masked.size());
  parallel_for(int(masked.size()), 1, [&](int m) { sums[m] = integral(mask_of(masked[m])); });
  low_ = world.bounds.min();
  cell_ = world.bounds.sizes().maxCoeff() / cells;
  const Eigen::Vector3d n = (world.bounds.sizes() / cell_).array().ceil();
  nx_ = std::max(1, int(n.x())), ny_ = std::max(1, int(n.y())), nz_ = std::max(1, int(n.z()));
  occupied_.assign(size_t(nx_) * ny_ * nz_, 0);
  // `open`: views that cut what lies around here; `cut`, if there, those that cut this.
  const auto in_all_masks = [&](const Eigen::Vector3d& p, double radius,
                                const std::vector<int>& open, std::vector<int>* cut) {
    Share least = kAll;
    for (const int m : open) {
      const View& v = world.views[masked[m]];
      double z;
      const Eigen::Vector2d q = v.project(p, &z);
      if (!(z > 0)) continue;
      const Share here = share(sums[m], v, q, radius * v.camera.fx / z);
      if (here == kNone) return kNone;
      if (here == kSome && cut) cut->push_back(m);
      least = std::min(least, here);
    }
    return least;
  };
  std::vector<int> all(masked.size());
  std::iota(all.begin(), all.end(), 0);
  // Blocks of cells first: most of space is empty, most of the rest deep inside.
  constexpr int kBlock = 4;
  const double half_diagonal = 0.87;  // of a cell, half the square root of 3
  const auto blocks = [](int cells) { return (cells + kBlock - 1) / kBlock; };
  const int across = blocks(nx_), rows = blocks(ny_);
  parallel_for(
      blocks(nz_) * rows * across, 16, [&](int b) {
        const int i0 = b % across * kBlock, j0 = b / across % rows * kBlock,
                  k0 = b / (across * rows) * kBlock;
        const Eigen::Vector3d middle =
            low_ + cell_ * (Eigen::Vector3d(i0, j0, k0) + Eigen::Vector3d::Constant(kBlock / 2.0));
        std::vector<int> cut;
        const Share block = in_all_masks(middle, kBlock * half_diagonal * cell_, all, &cut);
        if (block == kNone) return;
        for (int k = k0; k < std::min(nz_, k0 + kBlock); ++k)
          for (int j = j0; j < std::min(ny_, j0 + kBlock); ++j)
            for (int i = i0; i < std::min(nx_, i0 + kBlock); ++i) {
              const Eigen::Vector3d p = low_ + cell_ * Eigen::Vector3d(i + .5, j + .5, k + .5);
              occupied_[(size_t(k) * ny_ + j) * nx_ + i] =
                  block == kAll ? kAll : in_all_masks(p, half_diagonal * cell_, cut, nullptr);
            }
      });
}

uint8_t VisualHull::at(const Eigen::Vector3d& p) const {
  const Eigen::Vector3d q = (p - low_) / cell_;
  if (!(q.minCoeff() >= 0) || q.x() >= nx_ || q.y() >= ny_ || q.z() >= nz_) return kNone;
  return occupied_[(size_t(q.z()) * ny_ + size_t(q.y())) * nx_ + size_t(q.x())];
}

bool VisualHull::surely_visible(const Eigen::Vector3d& point, const Eigen::Vector3d& camera) const {
  if (empty()) return false;
  const Eigen::Vector3d way = camera - point;
  const double length = way.norm();
  // Where the line of sight leaves the grid.
  const Eigen::Array3d size = cell_ * Eigen::Array3d(nx_, ny_, nz_);
  const Eigen::Array3d far = (way.array() > 0).select(low_.array() + size, low_.array());
  double end = length;
  for (int k = 0; k < 3; ++k)
    if (way[k] != 0) end = std::min(end, std::max(0.0, (far[k] - point[k]) / way[k] * length));
  // Nearby cells may hold the point's own surface, but no more than its surface.
  for (double s = 0; s < std::min(kSurroundings * cell_, end); s += 0.35 * cell_)
    if (at(point + way * (s / length)) == kAll) return false;
  for (double s = kSurroundings * cell_; s < end; s += 0.7 * cell_)
    if (at(point + way * (s / length)) != kNone) return false;
  return true;
}

bool VisualHull::clip(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                      double around, double* s0, double* s1) const {
  if (empty()) return true;
  const double step = 0.5 * cell_;
  double first = *s0, last = *s1;
  while (first <= last && at(origin + first * direction) == kNone) first += step;
  while (first <= last && at(origin + last * direction) == kNone) last -= step;
  if (first > last) return false;
  *s0 = std::max(*s0, first - around * cell_), *s1 = std::min(*s1, last + around * cell_);
  return true;
}

}  // namespace sketchsplat
