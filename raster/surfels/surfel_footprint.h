// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "raster/surfels/surfel.h"

namespace sketchsplat {

/// A surfel in an image. With d = (dx, dy) a pixel minus `mean`, w = b0 dx + b1 dy + facing and
///   u' = (a00 dx + a01 dy) / w,  v' = (a10 dx + a11 dy) / w,  z = depth / w,
/// the ray of the pixel meets the plane of the surfel at depth z, and u'^2 + v'^2 = q3 log2(e) / 2:
/// the inverse of the homography disk -> image (the two planes of 2DGS), scaled. In the disk w is
/// above 1/2, for no part of it is behind the camera.
struct SurfelFootprint {
  int surfel;            ///< index into the cloud
  Eigen::Vector2d mean;  ///< [px] the projected centre
  int x0, x1, y0, y1;  ///< box of the pixels that it can reach, inclusive, in the image, not empty
  float a00, a01, a10, a11, b0, b1;
  float facing;          ///< 1; -1 if seen edge-on: then w < 0, which means that no ray meets it
  float depth;           ///< of the centre
  float opacity;         ///< peak of alpha, with the scale of the profile (lanes.h)
  float skew_u, skew_v;  ///< a . (u, v) = skew_u u' + skew_v v'
  float color[3];
  float normal[3];      ///< camera frame, faces the camera
  Eigen::Matrix3d rim;  ///< (dx, dy, 1) rim (dx, dy, 1)^T < 0 where q3 < cutoff^2
};

/// Gradient of a scalar by a footprint, summed over its pixels.
struct SurfelFootprintGradient {
  /// Those by (u' w, v' w, w) times (dx, dy, 1), that is by the nine numbers [a00 a01 0; a10 a11 0;
  /// b0 b1 facing].
  Eigen::Matrix3d plane = Eigen::Matrix3d::Zero();
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();  ///< where k(q2) is the larger one
  double depth = 0;                                ///< there, too
  double opacity = 0;
  Eigen::Vector2d skew = Eigen::Vector2d::Zero();
  Eigen::Vector3d color = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
  Eigen::Vector2d in_image_abs = Eigen::Vector2d::Zero();
  Eigen::Vector3d splitting = Eigen::Vector3d::Zero();
  double weight = 0;
};

/// Footprints of the surfels that reach the image, front to back: in the order of the centres'
/// depths, ties by index.
std::vector<SurfelFootprint> project_surfels(const SurfelCloud& cloud, const View& view,
                                             const SurfelOptions& options);

/// Pulls the gradient by a footprint back to its surfel: sets that column of `gradient`.
void project_surfel_backward(const SurfelCloud& cloud, const View& view,
                             const SurfelOptions& options, const SurfelFootprint& footprint,
                             const SurfelFootprintGradient& by_footprint, SurfelGradient* gradient);

}  // namespace sketchsplat
