// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// An end of a stroke, and the column of control points beside it: the line from the node to it is
/// the tangent there.
struct TangentEnd {
  int stroke = -1;
  bool at_end = false;
  bool is_node = false;  ///< `column` is of Sketch::nodes, the far end of a line; else of handles
  int column = -1;
};

/// Where a curve goes on smoothly: a node in which two cubics, or a cubic and a line, end, and
/// nothing else does.
struct SmoothJoint {
  int node = -1;
  TangentEnd before, after;
  double angle = 0;  ///< [rad] between the tangents, 0 if they continue one another
};

/// All joints that turn by at most `smooth_angle` [rad]. A cubic does not go on from itself.
std::vector<SmoothJoint> find_smooth_joints(const Sketch& sketch, double smooth_angle);

}  // namespace sketchsplat
