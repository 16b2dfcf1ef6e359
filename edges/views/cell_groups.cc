// SPDX-License-Identifier: MIT
#include "edges/views/cell_groups.h"

#include <map>

namespace sketchsplat {

std::vector<int> groups_of(const std::vector<Eigen::Vector3d>& places, double cell, int* count) {
  std::map<Cell, int> group;
  for (const Eigen::Vector3d& p : places) group[cell_of(p, cell)] = -1;
  *count = 0;
  for (auto& [start, g] : group) {
    if (g >= 0) continue;
    g = (*count)++;
    std::vector<Cell> open = {start};
    while (!open.empty()) {
      const Cell c = open.back();
      open.pop_back();
      for (int k = 0; k < 27; ++k) {
        const auto next = group.find(touching(c, k));
        if (next == group.end() || next->second >= 0) continue;
        next->second = group[start];
        open.push_back(next->first);
      }
    }
  }
  std::vector<int> out;
  for (const Eigen::Vector3d& p : places) out.push_back(group[cell_of(p, cell)]);
  return out;
}

}  // namespace sketchsplat
