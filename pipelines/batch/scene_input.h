// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "datasets/readers/open_options.h"

namespace sketchsplat {

/// Hash of what a scene folder holds, down to four folders below: the contents of files that may
/// hold cameras (json, txt, bin; at most 100 MB), names and sizes of all others. Does not look into
/// images. The same for a copy of the folder; an empty text if there is no such folder.
std::string input_hash(const std::string& folder);

/// Whether there is a truth for the scene, in it or above it; perhaps one that cannot be used.
bool has_truth(const std::string& folder);

/// How much a scene is, from its files' headers.
struct SceneSize {
  int views = 0;      ///< 0: the scene cannot be opened
  double pixels = 0;  ///< of all views
};
SceneSize scene_size(const std::string& folder, const OpenOptions& options);

}  // namespace sketchsplat
