// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "datasets/synthetic/photo/tie_points.h"
#include "datasets/types/view.h"

namespace sketchsplat {

/// Writes cameras.txt, images.txt and points3D.txt of COLMAP into a folder that exists. The views
/// share the first one's camera: OPENCV, or PINHOLE if its lens does nothing. Images count from 1
/// in the order of the views, points from 1, too. Throws OutputError.
void write_colmap(const std::vector<View>& views, const std::vector<TiePoint>& points,
                  const std::string& folder);

}  // namespace sketchsplat
