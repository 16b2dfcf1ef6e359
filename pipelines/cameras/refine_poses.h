// SPDX-License-Identifier: MIT
// In: a world by cameras that may err, and who fits strokes to it. Out: strokes, and cameras that
// they agree with. This folder may not include the method.
#pragma once

#include "datasets/readers/scene.h"
#include "edges/views/lift.h"
#include "pipelines/cameras/posed.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// The first strokes, and the cameras that they were found with.
struct PosedStrokes {
  EdgeWorld world;
  Sketch sketch;
  PriorOdds odds = {};   ///< see FirstStrokes
  bool refined = false;  ///< the cameras are not those that were stated, or fewer
};

/// Fits strokes (`fit` lifts edgels and fits); where the strokes' offsets in single views, or a
/// focal length or lens that fits them better, say that the cameras err (--refine-poses auto;
/// always with "on", never with "off"; of an object among things without masks also if the scene's
/// points lie beside their pixels), settles cameras and strokes together (settle.h) and keeps these
/// cameras if as many edgels lie on strokes. Views whose edgels do not fit the strokes of the
/// others are left out with a warning. Without any of this nothing changes. Throws TooLittleError
/// if views agree on hardly more than they would by accident. Points of structure from motion, if
/// the scene has any, hold the cameras where they fit them.
PosedStrokes pose_and_fit(const Scene& scene, EdgeWorld world, const StrokeFit& fit,
                          const MethodRun& run);

}  // namespace sketchsplat
