// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

namespace sketchsplat {

/// Cubes that hold an object, of which those of a positive field are inside. Those at the rim of
/// the grid are outside.
struct CellGrid {
  Eigen::Vector3d low = Eigen::Vector3d::Zero();  ///< corner of the first cell, world units
  double cell = 0;                                ///< side, world units
  int nx = 0, ny = 0, nz = 0;
  std::vector<float> field;  ///< > 0 inside, in cells, about the distance to the surface

  int size() const { return nx * ny * nz; }
  int index(int i, int j, int k) const { return (k * ny + j) * nx + i; }
  Eigen::Vector3d center(int c) const {
    return low + cell * Eigen::Vector3d(c % nx + .5, c / nx % ny + .5, c / (nx * ny) + .5);
  }
  bool inside(int i, int j, int k) const {
    return i >= 0 && j >= 0 && k >= 0 && i < nx && j < ny && k < nz && field[index(i, j, k)] > 0;
  }
  bool on_surface(int c) const {
    if (!(field[c] > 0)) return false;
    const int i = c % nx, j = c / nx % ny, k = c / (nx * ny);
    return !inside(i - 1, j, k) || !inside(i + 1, j, k) || !inside(i, j - 1, k) ||
           !inside(i, j + 1, k) || !inside(i, j, k - 1) || !inside(i, j, k + 1);
  }
};

}  // namespace sketchsplat
