// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "datasets/readers/scene.h"

namespace sketchsplat {

/// How a scene folder of strangers is to be read.
struct OpenOptions {
  std::string format;  ///< empty: the files in the folder decide
  /// Images and masks that the scene file places outside of the folder (by name: `..` or absolute
  /// paths) are read, too. Otherwise such frames are left out with a warning.
  bool allow_outside = false;
};

/// See open_scene(folder, format).
Scene open_scene(const std::string& folder, const OpenOptions& options);

}  // namespace sketchsplat
