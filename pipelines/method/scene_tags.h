// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "datasets/readers/scene.h"
#include "edges/tags/tag_square.h"
#include "pipelines/base/run_report.h"

namespace sketchsplat {

/// The AprilTags 36h11 of a scene, ascending by id; stage "tags". Pictures that cannot be read do
/// not count. Throws TooLittleError if not one can be measured.
std::vector<TagSquare> measure_tags(const Scene& scene, const RunLog& log);

}  // namespace sketchsplat
