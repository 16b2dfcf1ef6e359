// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "pipelines/base/run_report.h"

namespace sketchsplat {

/// Lets COLMAP, if it is installed, find the cameras of the photographs in `images` and below, on
/// the CPU: features, matches, mapping, a stage each. What lies in one of the folders `others`
/// (masks, results) below `images` is no photograph. `folder` is a scene of the format "colmap"
/// then (sparse/, a link to the images, colmap.log); if it is one already, of the same files
/// (names, sizes, times), nothing is done. `threads`: 0 for all. Throws InputError if COLMAP is not
/// there or stops, or there are fewer than three photographs; TooLittleError if it finds no
/// cameras; OutputError.
void find_cameras(const std::string& images, const std::vector<std::string>& others,
                  const std::string& folder, int threads, const RunLog& log);

}  // namespace sketchsplat
