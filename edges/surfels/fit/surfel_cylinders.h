// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "edges/surfels/model/surfel_set.h"

namespace sketchsplat {

struct CylinderOptions {
  double angle_deg = 20;  ///< [deg] between a surfel's normal and that of its cylinder
  double reach = 0.5;     ///< [spacings] from a surfel to its cylinder
  double lean_deg =
      3.5;              ///< [deg] of normals along the axis, steady: else a cone, a sphere, a ring
  double arc_deg = 75;  ///< [deg] of a turn that a cylinder shows at least
  int fewest = 40;      ///< surfels that make a cylinder; 0: none are looked for
  int seed = 0;         ///< of the pairs that are drawn
};

/// Lays surfels that make a cylinder exactly on it: pairs of neighbours propose cylinders, as in
/// RANSAC (Schnabel et al., Efficient RANSAC for point-cloud shape detection, Computer Graphics
/// Forum 2007); those with the largest connected sets of surfels are fitted to places and normals
/// of what lies on them from end to end. Surfels that are `taken`, one flag each, are left alone.
/// Returns how many lie on cylinders now. The same set, the same result.
int round_surfels(double spacing, const CylinderOptions& options, const std::vector<char>& taken,
                  SurfelSet* set);

}  // namespace sketchsplat
