// SPDX-License-Identifier: MIT
#pragma once

#include <utility>
#include <vector>

#include "raster/surfels/surfel.h"

namespace sketchsplat {

/// Adds to `gradient` that of the edge-aware smoothness of neighbours
///   weight / |pairs| sum_ij w_ij ((1 - n_i . n_j) + ((p_j - p_i) . (n_i + n_j) / (2 spacing))^2),
/// w_ij = exp(-(angle_ij / edge_deg)^2) taken as a constant: neighbours on one plane are pulled to
/// it, those across an edge leave each other alone (as in Huang et al., Edge-aware point set
/// resampling, TOG 2013). Returns the value.
double smooth_gradient(const SurfelCloud& cloud, const std::vector<std::pair<int, int>>& pairs,
                       double spacing, double edge_deg, double weight, SurfelCloud* gradient);

}  // namespace sketchsplat
