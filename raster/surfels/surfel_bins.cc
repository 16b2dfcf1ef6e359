// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "raster/surfels/surfel_tiles.h"

namespace sketchsplat {
namespace {

constexpr int kSide = Tile::kSide;

// Least value of a x^2 + 2 b x + c, a >= 0, for x in [low, high].
double least_on_edge(double a, double b, double c, double low, double high) {
  const double x = a > 0 ? std::clamp(-b / a, low, high) : (b > 0 ? low : high);
  return (a * x + 2 * b) * x + c;
}

// Whether the ellipse (d, 1) rim (d, 1)^T < 0 has no point in the rectangle. Its form is convex and
// its centre is the least of it, so that, unless the centre is inside, the least value in the
// rectangle is on an edge.
bool misses(const Eigen::Matrix3d& rim, double x0, double x1, double y0, double y1) {
  const auto at_x = [&](double x) {
    return least_on_edge(rim(1, 1), rim(0, 1) * x + rim(1, 2),
                         (rim(0, 0) * x + 2 * rim(0, 2)) * x + rim(2, 2), y0, y1);
  };
  const auto at_y = [&](double y) {
    return least_on_edge(rim(0, 0), rim(0, 1) * y + rim(0, 2),
                         (rim(1, 1) * y + 2 * rim(1, 2)) * y + rim(2, 2), x0, x1);
  };
  const double determinant = rim(0, 0) * rim(1, 1) - rim(0, 1) * rim(0, 1);
  if (!(determinant > 0)) return false;  // no ellipse for doubles
  const double x = (rim(0, 1) * rim(1, 2) - rim(1, 1) * rim(0, 2)) / determinant;
  const double y = (rim(0, 1) * rim(0, 2) - rim(0, 0) * rim(1, 2)) / determinant;
  if (x >= x0 && x <= x1 && y >= y0 && y <= y1) return false;
  return std::min(std::min(at_x(x0), at_x(x1)), std::min(at_y(y0), at_y(y1))) > 0;
}

bool misses_tile(const SurfelFootprint& f, double reach, int tx, int ty) {
  const double x0 = tx * kSide - f.mean.x(), y0 = ty * kSide - f.mean.y();
  const double x1 = x0 + kSide - 1, y1 = y0 + kSide - 1;
  const double dx = std::max({x0, -x1, 0.0}), dy = std::max({y0, -y1, 0.0});
  if (dx * dx + dy * dy < reach * reach) return false;
  return f.facing < 0 || misses(f.rim, x0, x1, y0, y1);
}

std::uint64_t mask_bits(const Image<std::uint8_t>& mask, const Camera& camera, int tx, int ty) {
  std::uint64_t bits = 0;
  for (int y = 0; y < std::min(kSide, camera.height - ty * kSide); ++y) {
    for (int x = 0; x < std::min(kSide, camera.width - tx * kSide); ++x) {
      const bool wanted = mask.empty() || mask.at(tx * kSide + x, ty * kSide + y) != 0;
      bits |= std::uint64_t(wanted) << (y * kSide + x);
    }
  }
  return bits;
}

}  // namespace

SurfelBins bin_surfels(const std::vector<SurfelFootprint>& footprints, const Camera& camera,
                       const Image<std::uint8_t>& mask, const SurfelOptions& options) {
  const int tiles_x = (camera.width + kSide - 1) / kSide;
  const int tiles_y = (camera.height + kSide - 1) / kSide;
  std::vector<std::uint64_t> bits(size_t(tiles_x) * tiles_y);
  for (int ty = 0; ty < tiles_y; ++ty) {
    for (int tx = 0; tx < tiles_x; ++tx) {
      bits[size_t(ty) * tiles_x + tx] = mask_bits(mask, camera, tx, ty);
    }
  }
  // First the tile of every entry, in the order of the footprints; then a counting sort by tile,
  // which keeps that order, so that every tile is front to back.
  SurfelBins bins;
  std::vector<int> count(bits.size() + 1, 0);
  bins.first_slot.push_back(0);
  const double reach = options.cutoff * options.lowpass_px;
  for (const SurfelFootprint& f : footprints) {
    for (int ty = f.y0 / kSide; ty <= f.y1 / kSide; ++ty) {
      for (int tx = f.x0 / kSide; tx <= f.x1 / kSide; ++tx) {
        const int tile = ty * tiles_x + tx;
        if (bits[tile] == 0 || misses_tile(f, reach, tx, ty)) continue;
        bins.slots.push_back(tile);
        ++count[tile];
      }
    }
    bins.first_slot.push_back(int(bins.slots.size()));
  }
  int begin = 0;
  for (size_t t = 0; t < bits.size(); ++t) {
    const int end = begin + count[t];
    if (count[t]) {
      bins.tiles.push_back({int(t) % tiles_x, int(t) / tiles_x, begin, end, bits[t]});
    }
    count[t] = begin;
    begin = end;
  }
  bins.entries.resize(bins.slots.size());
  for (size_t f = 0; f < footprints.size(); ++f) {
    for (int k = bins.first_slot[f]; k < bins.first_slot[f + 1]; ++k) {
      const int slot = count[bins.slots[k]]++;
      bins.entries[slot] = int(f);
      bins.slots[k] = slot;
    }
  }
  return bins;
}

}  // namespace sketchsplat
