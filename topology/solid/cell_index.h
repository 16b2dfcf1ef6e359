// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "topology/solid/cells.h"

namespace sketchsplat {

/// Answers many times whether a point of the layout lies in a cell; coordinates may be off by
/// periods. The pieces of the cell's polygons are sorted into bins of the first coordinate, and
/// those above the point counted: an odd number is inside.
class CellIndex {
 public:
  CellIndex(const Cell& cell, const Layout& layout);
  bool holds(const Eigen::Vector2d& flat) const;

 private:
  struct Piece {
    Eigen::Vector2d a, b;
  };
  void add(const Eigen::Vector2d& a, const Eigen::Vector2d& b);
  bool is_below_odd(const Eigen::Vector2d& p) const;

  double low_, high_;      // bounds of the second coordinate
  double first_, width_;   // of the bins
  double period_, again_;  // of the two coordinates, 0: none
  std::vector<std::vector<Piece>> bins_;
};

}  // namespace sketchsplat
