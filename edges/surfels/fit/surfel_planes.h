// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "edges/surfels/model/surfel_set.h"

namespace sketchsplat {

struct PlaneOptions {
  double angle_deg = 6;  ///< [deg] between a surfel's normal and that of its plane
  double reach = 0.25;   ///< [spacings] from a surfel to its plane
  double bend_deg = 6;   ///< [deg] by which normals may turn steadily from end to end of a plane
  int fewest = 25;       ///< surfels that make a plane; 0: none are looked for
};

/// Lays surfels that make a plane exactly on it: regions grow from the evenest surfels over their
/// neighbours (as in Rabbani et al., Segmentation of point clouds using smoothness constraints,
/// 2006), their planes fitted anew as they grow. Regions whose normals turn steadily, pieces of a
/// round surface, stay as they are. Returns, per surfel, whether it lies on a plane now.
std::vector<char> flatten_surfels(double spacing, const PlaneOptions& options, SurfelSet* set);

}  // namespace sketchsplat
