// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "datasets/types/view.h"

namespace sketchsplat {

/// What is wrong with the scene's files; the images show what the true cameras see.
struct DegradeOptions {
  double pose_noise_px = 0;  ///< mean shift of the object's points by errors of poses, [0, 100]
  double focal_error_percent = 0;  ///< how much the focal length is too large [%], [-50, 50]
  double missing = 0;              ///< share of frames whose image is not there, [0, 1]
  double truncated = 0;            ///< share of frames whose image ends in the middle, [0, 1]
};

/// The cameras as the scene's file states them. Every pose is turned about its camera and moved by
/// normal deviates, so scaled that the projections of `points` (3 x N) move by
/// `pose_noise_px` on average over points and views; half of it is due to turns. A larger value is
/// the same error, scaled. All focal lengths are wrong by the same factor.
std::vector<View> stated_views(const std::vector<View>& views, const Eigen::Matrix3Xd& points,
                               const DegradeOptions& options, std::uint64_t seed);

enum class Fate { kWhole, kMissing, kTruncated };

/// What happens to each image: exactly the shares, rounded to whole frames. A larger share includes
/// the frames of a smaller one; no frame is both until they are more than all.
std::vector<Fate> fates(int views, const DegradeOptions& options, std::uint64_t seed);

}  // namespace sketchsplat
