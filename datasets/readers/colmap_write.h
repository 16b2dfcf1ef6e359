// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "datasets/types/view.h"

namespace sketchsplat {

/// What stands in cameras.txt, images.txt and points3D.txt of COLMAP.
struct ColmapText {
  std::string cameras, images, points;
};

/// A model of these cameras; `points` is but the heading of its columns. Views with the same size,
/// intrinsics and lens share a camera; images and cameras count from 1 in the order of the views.
/// `sights`: the second line (POINTS2D) of each image; empty: none has any.
ColmapText colmap_text(const std::vector<View>& views, const std::vector<std::string>& sights = {});

/// Of each view, which camera took it: views with the same size, intrinsics and lens share one.
std::vector<int> shared_cameras(const std::vector<View>& views);

}  // namespace sketchsplat
