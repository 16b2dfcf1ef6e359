// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "datasets/synthetic/photo/photo_light.h"
#include "datasets/types/triangulate.h"
#include "datasets/types/view.h"

namespace sketchsplat {

/// A point of a surface and where pictures show it, as structure from motion would match it.
struct TiePoint {
  Eigen::Vector3d point;           ///< in the frame of the views
  Color color;                     ///< share of the light that is sent back
  std::vector<PointSight> sights;  ///< three or more, in the order of the views
};

/// About a hundred points a view, evenly over its pixels, of what three or more views show well,
/// fewer where surfaces show nothing to hold on to; a third of the sights is left out, as matching
/// does. Unit frame.
std::vector<TiePoint> tie_points(const PhotoWorld& world, const PhotoShader& shader,
                                 const std::vector<View>& views, double lift, std::uint64_t seed);

/// The same sights with the points where these cameras see them (least squares); those that have
/// none in front of the cameras are left out.
std::vector<TiePoint> triangulated(const std::vector<TiePoint>& points,
                                   const std::vector<View>& views);

/// Mean distance between a point's sights and where the views draw it [px].
double reprojection_error(const TiePoint& point, const std::vector<View>& views);

}  // namespace sketchsplat
