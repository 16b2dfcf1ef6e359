// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "datasets/image.h"

namespace sketchsplat {

/// The geometry that one view sees, a value per pixel, sampled at the pixel's centre.
struct GeometryMaps {
  Image<float> depth;                  ///< along the camera's axis, world units; <= 0: nothing there
  std::array<Image<float>, 3> normal;  ///< camera frame (x right, y down, z forward), unit, towards
                                       ///< the camera; zero: nothing there
  Image<float> alpha;                  ///< coverage by the object, [0, 1]
  int width() const { return depth.width; }
  int height() const { return depth.height; }
};

}  // namespace sketchsplat
