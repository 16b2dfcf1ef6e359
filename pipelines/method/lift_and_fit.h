// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "edges/views/lift.h"
#include "pipelines/cameras/posed.h"
#include "pipelines/options/run.h"
#include "pipelines/survey/select.h"

namespace sketchsplat {

/// The space sweep over all edgels; stage "lift". Throws TooLittleError if no point is found.
std::vector<EdgePoint> lift_scene(const EdgeWorld& world, const MethodRun& run);

/// Strokes from lifted points, stage "fit": linked to chains, cut into the simplest curves, moved
/// onto the edgels, chosen by what they explain, and as long as the views see them.
FirstStrokes fit_strokes(const std::vector<EdgePoint>& points, const EdgeWorld& world,
                         const MethodRun& run);

/// Both, one after the other: a StrokeFit.
FirstStrokes lift_and_fit(const EdgeWorld& world, const MethodRun& run);

/// Strokes of the edgels that no stroke of `sketch` explains, not chosen yet. They are few, so that
/// fewer views need to agree on a point.
Sketch strokes_of_rest(const Sketch& sketch, const EdgeWorld& world,
                       const ReconstructOptions& options);

/// Strokes as long as the views see them, and moved onto the edgels.
Sketch grown(const Sketch& sketch, const EdgeWorld& world, const ReconstructOptions& options);

/// Chains of strokes in as few curves as their edgels allow; true if any changed.
bool rewrite_chains(const EdgeWorld& world, const ReconstructOptions& options, Sketch* sketch);

/// What select_strokes() decided, a line for each stroke that was not kept, for those who watch
/// closely.
void note_verdicts(const Sketch& sketch, const Selection& selection, const RunLog& log);

}  // namespace sketchsplat
