// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "datasets/camera.h"
#include "datasets/pose.h"

namespace sketchsplat {

/// One calibrated image.
struct View {
  std::string name;        ///< file name of the image, as outputs are called
  std::string image_path;  ///< where to read it
  Camera camera;           ///< width and height are filled from the image if the scene file is silent
  Pose cam_from_world;

  Eigen::Vector3d center_in_world() const {
    return -(cam_from_world.rotation.transpose() * cam_from_world.translation);
  }
  /// Pixel of a world point; `depth` (z in the camera) may be <= 0, then the pixel means nothing.
  Eigen::Vector2d project(const Eigen::Vector3d& point_in_world, double* depth) const {
    const Eigen::Vector3d p = cam_from_world * point_in_world;
    *depth = p.z();
    return camera.project(p);
  }
};

}  // namespace sketchsplat
