// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "datasets/readers/scene.h"

namespace sketchsplat {

/// Where a pixel lies in the picture of 1 / denominator the size; see Camera::shrunk.
Eigen::Vector2d shrunk(const Eigen::Vector2d& pixel, int denominator);

/// The scene with pictures whose longer side is at least twice `least_side` made smaller by the
/// largest whole factor that leaves so many pixels: blocks of pixels become one where a picture is
/// read, masks with it, and cameras are those of the smaller pictures. 0 leaves all as they are.
Scene with_smaller_pictures(const Scene& scene, int least_side);

/// Where views, some or all of a scene in its order, stand in it, by their names and files. Throws
/// std::out_of_range if one is not there.
std::vector<int> places_in(const Scene& scene, const std::vector<View>& views);

/// Views of `smaller`, some or all in its order, with cameras that may have moved since: the same
/// for the pictures of the scene that it was made of.
std::vector<View> at_full_size(const std::vector<View>& views, const Scene& smaller,
                               const Scene& scene);

}  // namespace sketchsplat
