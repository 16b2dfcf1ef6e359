// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "datasets/types/view.h"

namespace sketchsplat {

/// Where a view shows a point.
struct PointSight {
  int view = 0;           ///< index into the views of the scene
  Eigen::Vector2d pixel;  ///< in the image, where the lens draws it; NaN if nobody says
};

/// Moves a point from where it is to where views see it: least squares of distances in ideal pixels
/// (Gauss and Newton's method). False if it does not lie before all of them, or a lens draws a
/// pixel nowhere. `information`, unless null: inverse covariance of the place for pixels of
/// standard deviation 1.
bool triangulate(const std::vector<View>& views, const std::vector<PointSight>& sights,
                 Eigen::Vector3d* point, Eigen::Matrix3d* information = nullptr);

}  // namespace sketchsplat
