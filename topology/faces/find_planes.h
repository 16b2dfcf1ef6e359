// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sketches/graph/sketch.h"

namespace sketchsplat {

struct Plane {
  Eigen::Vector3d origin;
  Eigen::Vector3d x, y, normal;  ///< right-handed orthonormal frame
};

struct PlaneStrokes {
  Plane plane;
  std::vector<int> strokes;  ///< that lie in it, ascending
};

/// 3 x (pieces + 1) points along every stroke, from begin to end, both included; two along lines.
std::vector<Eigen::Matrix3Xd> polylines_of(const Sketch& sketch, int pieces = 32);

/// Planes grow from strokes that meet, and from single bent strokes, over neighbours, as long as
/// one least-squares plane keeps all within the tolerance (world units); strokes that do not touch
/// join the plane that they lie in. No set of strokes comes twice.
std::vector<PlaneStrokes> find_planes(const Sketch& sketch,
                                      const std::vector<Eigen::Matrix3Xd>& polylines,
                                      double tolerance);

}  // namespace sketchsplat
