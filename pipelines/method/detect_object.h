// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "datasets/readers/scene.h"
#include "edges/tags/tag_square.h"
#include "edges/views/lift.h"
#include "pipelines/detectors/detectors.h"
#include "pipelines/options/run.h"

namespace sketchsplat {

/// Finds the edgels of every view by the detector (detectors.h). Frames that cannot be read are
/// left out with a warning. Throws TooLittleError if fewer than three views hold edges, InputError
/// if no image, or no map of that name, can be read. What lies on tags is left out.
EdgeWorld detect_scene(const Scene& scene, Detector* detector, const std::vector<TagSquare>& tags,
                       const MethodRun& run);

/// Without masks: finds the object among other things (find_object.h) by the most meaningful edges,
/// and leaves out edgels that cannot be of it. With masks nothing changes. If the user gave a box,
/// the object is what lies in it, with masks or without.
EdgeWorld focus_on_object(EdgeWorld world, const MethodRun& run);

/// Without masks, where the object is known (focus_on_object): its silhouettes by colours, if those
/// of nearly all views agree (silhouettes.h); a detector that looks at single pictures looks again
/// at what lies on them, and for outlines by colours (outlines.h). `scene`: of the world's views.
EdgeWorld add_silhouettes(const Scene& scene, const Detector& detector, EdgeWorld world,
                          const MethodRun& run);

}  // namespace sketchsplat
