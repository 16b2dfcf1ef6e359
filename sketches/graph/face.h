// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

namespace sketchsplat {

/// A stroke as a part of a loop, run from its begin to its end or the other way.
struct LoopStroke {
  int stroke;
  bool forward;
};
/// Each stroke ends where the next begins, the last where the first does.
using Loop = std::vector<LoopStroke>;

/// A piece of a plane between loops of strokes. The outer loop runs counter-clockwise about the
/// normal, the holes clockwise.
struct PlanarFace {
  Eigen::Vector3d point;   ///< of the plane, world units
  Eigen::Vector3d normal;  ///< unit
  Loop outer;
  std::vector<Loop> holes;
};

}  // namespace sketchsplat
