// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "topology/solid/cells.h"

namespace sketchsplat {

/// Answers many times whether a point lies in a cell: the pieces of its polygons, sorted into bins
/// of the first coordinate. The same answers as holds().
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

  double first_, width_;   // of the bins
  double period_, again_;  // of the two coordinates, 0: none
  std::vector<std::vector<Piece>> bins_;
};

}  // namespace sketchsplat
