// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "sketches/graph/sketch.h"
#include "sketches/graph/solid.h"

namespace sketchsplat {

/// The file itself, or sketch.json in the folder that `reconstruct` wrote.
std::string sketch_file(const std::string& given);

/// Throws InputError.
Sketch read_sketch(const std::string& given);

/// solid.json in that folder, or beside that file.
std::string solid_file(const std::string& given);

/// Throws InputError.
Solid read_solid(const std::string& given);

/// How a sketch was made, from the files beside it.
struct SketchOrigin {
  double footprint = 0;  ///< world length of a pixel at the object; 0 if unknown
  /// Relative standard deviation of the size that the cameras leave open, where they were moved.
  double pose_scale_sigma = 0;
  std::string scene;  ///< folder of the images; empty if unknown or gone
};
SketchOrigin sketch_origin(const std::string& given);

}  // namespace sketchsplat
