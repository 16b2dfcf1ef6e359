// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>

#include "datasets/types/image.h"

namespace sketchsplat {

struct Scene;
struct View;

/// The geometry that one view sees, a value per pixel, sampled at the pixel's centre.
struct GeometryMaps {
  Image<float> depth;  ///< along the camera's axis, world units; <= 0: nothing there
  std::array<Image<float>, 3> normal;  ///< camera frame (x right, y down, z forward), unit, towards
                                       ///< the camera; zero: nothing there
  Image<float> alpha;                  ///< coverage by the object, [0, 1]
  int width() const { return depth.width; }
  int height() const { return depth.height; }
};

/// Reads depth/<name>.exr (one channel), normal/<name>.exr (x, y, z in the camera frame above) and,
/// if it is there, mask/<name>.png of the scene; without a mask the object is where depth is.
/// <name> is the image's name without its ending, or what precedes "_colors" in it. `normals` names
/// the folder of the normals, in the scene or, if there is none, anywhere; PNG in it are read as
/// estimators write them (normal_map.h). Throws InputError, also if a map has another size than the
/// view.
GeometryMaps read_geometry_maps(const Scene& scene, const View& view,
                                const std::string& normals = "normal");

/// A file about a view, by the names above: `folder`/<name>`ending`; empty if there is none.
std::string file_of_view(const std::string& folder, const View& view, const std::string& ending);

}  // namespace sketchsplat
