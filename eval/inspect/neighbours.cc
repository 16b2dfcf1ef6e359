// SPDX-License-Identifier: MIT
#include "eval/inspect/neighbours.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace sketchsplat {

bool parallel(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  constexpr double kParallel = 0.1 * M_PI / 180;
  return a.cross(b).norm() < std::sin(kParallel);
}

std::vector<std::pair<int, int>> neighbours(std::vector<std::pair<double, int>> offsets,
                                            double same) {
  std::sort(offsets.begin(), offsets.end());
  std::vector<int> kept;
  double last = -std::numeric_limits<double>::infinity();
  for (const auto& [offset, index] : offsets) {
    if (offset - last < same) continue;
    kept.push_back(index);
    last = offset;
  }
  std::vector<std::pair<int, int>> out;
  for (size_t i = 0; i + 1 < kept.size(); ++i) out.push_back({kept[i], kept[i + 1]});
  if (kept.size() > 2) out.push_back({kept.front(), kept.back()});
  return out;
}

std::vector<std::pair<int, int>> spanning_tree(int count,
                                               const std::function<double(int, int)>& distance) {
  std::vector<std::pair<int, int>> out;
  std::vector<bool> in(size_t(std::max(count, 1)));
  in[0] = true;
  while (int(out.size()) + 1 < count) {
    double least = std::numeric_limits<double>::infinity();
    std::pair<int, int> next;
    for (int i = 0; i < count; ++i)
      for (int k = 0; k < count && in[i]; ++k) {
        if (in[k]) continue;
        const double d = distance(i, k);
        if (d < least) least = d, next = {i, k};
      }
    in[next.second] = true;
    out.push_back(next);
  }
  return out;
}

}  // namespace sketchsplat
