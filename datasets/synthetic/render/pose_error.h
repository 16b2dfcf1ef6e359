// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "datasets/types/view.h"

namespace sketchsplat {

/// Cameras as structure from motion might have found them. They swing about the points, stand
/// nearer or further and look a little past them, by what runs smoothly over the places of the
/// cameras, so that neighbours share most of it, and by something of each camera's own; focal
/// length, principal point and, where there is one, the lens are wrong for all alike, and the poses
/// make up for the most of that. What a similarity of the world could undo has been undone. `px`:
/// RMS of the shift of `points` (3 x N) in the images, over points and views, of what the lens
/// draws. More of it is about the same error, scaled.
std::vector<View> with_pose_error(const std::vector<View>& views, const Eigen::Matrix3Xd& points,
                                  double px, std::uint64_t seed);

/// Root mean square of the distances of where two sets of cameras draw points [px].
double rms_shift(const std::vector<View>& a, const std::vector<View>& b,
                 const Eigen::Matrix3Xd& points);

}  // namespace sketchsplat
