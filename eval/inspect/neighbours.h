// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>
#include <set>
#include <utility>
#include <vector>

namespace sketchsplat {

/// Are two unit vectors parallel, or opposite, to a tenth of a degree?
bool parallel(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

/// Pairs of neighbours among things (indices) at some offsets, and the two outer ones if there are
/// more than two; one that is less than `same` from the last one counts as that.
std::vector<std::pair<int, int>> neighbours(std::vector<std::pair<double, int>> offsets,
                                            double same);

/// Of each set of parallel things, those that are neighbours across. direction(i): unit vector;
/// offset(a, b): of b from a.
template <typename Direction, typename Offset>
std::vector<std::pair<int, int>> parallel_neighbours(const std::vector<int>& things,
                                                     const Direction& direction,
                                                     const Offset& offset, double same) {
  std::vector<std::pair<int, int>> out;
  std::set<int> done;
  for (const int a : things) {
    if (done.count(a)) continue;
    std::vector<std::pair<double, int>> offsets;
    for (const int b : things)
      if (!done.count(b) && parallel(direction(a), direction(b))) {
        offsets.push_back({offset(a, b), b});
        done.insert(b);
      }
    for (const auto& pair : neighbours(offsets, same)) out.push_back(pair);
  }
  return out;
}

/// Pairs of 0..count-1 that a least spanning tree joins (Prim's algorithm).
std::vector<std::pair<int, int>> spanning_tree(int count,
                                               const std::function<double(int, int)>& distance);

}  // namespace sketchsplat
