// SPDX-License-Identifier: MIT
#include "edges/image/hatching.h"

#include <cmath>

namespace sketchsplat {
namespace {

constexpr double kBefore = 0.001;                              // of all edgels are of hatching
constexpr double kNextInHatching = 0.8, kNextElsewhere = 0.2;  // chance of one more rung
constexpr int kMostRungs = 12;                                 // on a side: more tell no more
constexpr int kNearestPx = 2, kFarthestPx = 6;                 // of a rung from the last one
constexpr float kAlike = 0.5f;                                 // times the strength of the edgel
constexpr float kAlong = 0.966f;  // cosine between their normals: 15 deg

}  // namespace

Hatching::Hatching(const EdgelMap& map, cv::Size size) : map_(map), at_(size, -1) {
  for (int i = 0; i < int(map.edgels.size()); ++i)
    at_(int(std::lround(map.edgels[i].y)), int(std::lround(map.edgels[i].x))) = i;
}

double Hatching::chance(const Edgel& edgel) const {
  const int n = rungs(edgel, 1) + rungs(edgel, -1);
  const double against =
      (1 - kBefore) / kBefore * std::pow(kNextElsewhere / kNextInHatching, double(n));
  return 1 / (1 + against);
}

// The nearest one to the point `from_px` across the edgel, or null.
const Edgel* Hatching::next_rung(const Edgel& e, int side, double from_px) const {
  for (int t = kNearestPx; t <= kFarthestPx; ++t)
    for (const int s : {0, 1, -1}) {  // chains have gaps
      const double across = from_px + side * t;
      const int x = int(std::lround(e.x + across * e.nx - s * e.ny));
      const int y = int(std::lround(e.y + across * e.ny + s * e.nx));
      if (x < 0 || y < 0 || x >= at_.cols || y >= at_.rows || at_(y, x) < 0) continue;
      const Edgel& other = map_.edgels[at_(y, x)];
      if (other.strength >= kAlike * e.strength &&
          std::abs(other.nx * e.nx + other.ny * e.ny) >= kAlong)
        return &other;
    }
  return nullptr;
}

int Hatching::rungs(const Edgel& e, int side) const {
  double at_px = 0;
  for (int n = 0; n < kMostRungs; ++n) {
    const Edgel* next = next_rung(e, side, at_px);
    if (!next) return n;
    at_px = (next->x - e.x) * e.nx + (next->y - e.y) * e.ny;
  }
  return kMostRungs;
}

}  // namespace sketchsplat
