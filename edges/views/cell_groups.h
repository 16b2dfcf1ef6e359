// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <vector>

namespace sketchsplat {

/// A cube of a grid.
using Cell = std::array<int, 3>;
inline Cell cell_of(const Eigen::Vector3d& place, double side) {
  return {int(std::floor(place.x() / side)), int(std::floor(place.y() / side)),
          int(std::floor(place.z() / side))};
}
/// The cell and the 26 that touch it, k from 0 to 26.
inline Cell touching(const Cell& c, int k) {
  return {c[0] + k / 9 - 1, c[1] + k / 3 % 3 - 1, c[2] + k % 3 - 1};
}

/// Groups of places: what lies in one cell of a grid, or in cells that touch, is one. The group of
/// each place; `count`: their number.
std::vector<int> groups_of(const std::vector<Eigen::Vector3d>& places, double cell, int* count);

}  // namespace sketchsplat
