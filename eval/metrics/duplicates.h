// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

namespace sketchsplat {

/// Share, per cent, of the length of all strokes (samples in order, 3 x N each) that runs beside
/// another stroke: closer than 0.005, directions within 15 degrees, and not merely before its end
/// or after it. Both of two copies count. NaN if there is no length.
double duplicated_share(const std::vector<Eigen::Matrix3Xd>& strokes);

}  // namespace sketchsplat
