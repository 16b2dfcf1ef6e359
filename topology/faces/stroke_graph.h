// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sketches/graph/face.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// A simple closed walk over strokes of a surface, in the coordinates that the surface is laid out
/// in.
struct Cycle {
  Loop loop;
  Eigen::Matrix2Xd polygon;  ///< 2 x n corners, the first one not repeated
  double area = 0;           ///< positive if counter-clockwise; 0 if it runs around the surface
  int turns = 0;             ///< around the surface: in the direction of the first coordinate
  int turns_across = 0;      ///< in the direction of the second one
  int part = -1;             ///< connected part of the graph
  int walk = -1;             ///< walk of the graph that it was cut from
};

/// Simple cycles of the graph that `members` (strokes of the sketch) form on a surface, without its
/// dangling strokes and bridges; each keeps its inside on the left.
/// `lines`: per member, 2 x n points from its begin to its end in coordinates of the surface.
/// `period`: of the coordinates, for surfaces that close; 0 of one that does not.
std::vector<Cycle> simple_cycles(const Sketch& sketch, const std::vector<int>& members,
                                 const std::vector<Eigen::Matrix2Xd>& lines,
                                 const Eigen::Vector2d& period = Eigen::Vector2d::Zero());

bool is_inside(const Eigen::Vector2d& p, const Eigen::Matrix2Xd& polygon);

}  // namespace sketchsplat
