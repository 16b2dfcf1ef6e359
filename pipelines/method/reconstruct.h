// SPDX-License-Identifier: MIT
// In: a scene and options. Out: its edges as curves, the solid that they bound, and a report of the
// run. This folder may not include files that are written (results, pages) or command lines.
#pragma once

#include "datasets/readers/scene.h"
#include "edges/tags/tag_square.h"
#include "pipelines/base/run_report.h"
#include "pipelines/detectors/detectors.h"
#include "pipelines/method/blends.h"
#include "pipelines/options/options.h"
#include "sketches/graph/sketch.h"
#include "topology/solid/find_solid.h"

namespace sketchsplat {

struct Reconstruction {
  Sketch sketch;
  RunReport report;
  std::vector<std::string> views;  ///< names of those that Evidence::views counts
  std::vector<View> refined;       ///< the cameras, if they are not those of the scene; else empty
  std::vector<TagSquare> tags;     ///< that were asked for
  SolidSearch solid;               ///< what the strokes bound, or why there is none
  Blends blends;                   ///< rounded edges, if they were asked for; no part of the sketch
};

/// The edges of the object in the scene, at least one. Throws TooLittleError if there is none,
/// InputError if the detector needs files that are not there. Once the budget is used up, what was
/// found is polished once and reported; the report says so. `progress` may be null.
Reconstruction reconstruct(const Scene& scene, const ReconstructOptions& options,
                           Progress* progress);
/// The same with a detector that somebody else has made; `options.detector` does not count.
Reconstruction reconstruct(const Scene& scene, Detector* detector,
                           const ReconstructOptions& options, Progress* progress);

}  // namespace sketchsplat
