// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "edges/surfels/model/training_view.h"

namespace sketchsplat {

/// A view at one resolution, cut to the pixels that are looked at, and which these are.
struct SurfelTarget {
  TrainingView view;
  Image<std::uint8_t> mask;  ///< the object and a margin of 1/25 of the side around it
  double footprint = 0;      ///< of a pixel at the object's middle, world units
};

/// All views with their longer side at most `side` [px].
std::vector<SurfelTarget> make_targets(const std::vector<TrainingView>& views, int side,
                                       const Eigen::Vector3d& middle);

}  // namespace sketchsplat
