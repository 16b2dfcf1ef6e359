// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "datasets/readers/open_options.h"
#include "pipelines/batch/scene_list.h"

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

/// Opens the scenes in a child process, as strangers' files may end it; what it dies of, or takes
/// longer than `patience_seconds` for, has no size. `step` is called after each.
std::vector<SceneSize> scene_sizes(const std::vector<BatchScene>& scenes,
                                   const OpenOptions& options, double patience_seconds,
                                   const std::function<void()>& step);

}  // namespace sketchsplat
