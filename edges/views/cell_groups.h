// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

namespace sketchsplat {

/// Groups of places: what lies in one cell of a grid, or in cells that touch, is one. The group of
/// each place; `count`: their number.
std::vector<int> groups_of(const std::vector<Eigen::Vector3d>& places, double cell, int* count);

}  // namespace sketchsplat
