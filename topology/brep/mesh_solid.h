// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "sketches/graph/solid.h"

namespace sketchsplat {

/// A face of a solid as triangles, world units.
struct FaceMesh {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<int, 3>> triangles;  ///< corners counter-clockwise seen from outside
  double area = 0;                            ///< of the exact face
};

/// The faces of a solid in their order; chords stay within `deflection` (of the
/// extent) of the faces. Empty if it cannot be built: see write_solid_step.
std::vector<FaceMesh> mesh_solid(const Solid& solid, double deflection);

}  // namespace sketchsplat
