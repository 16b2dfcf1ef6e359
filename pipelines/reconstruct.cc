// SPDX-License-Identifier: MIT
#include "pipelines/reconstruct.h"

#include <memory>

#include "datasets/errors.h"
#include "pipelines/detectors.h"
#include "pipelines/refine_poses.h"
#include "pipelines/stages.h"

namespace sketchsplat {

// The method. Images become edgels, edgels points in space, points strokes, and these
// tell whether the cameras err; then rounds of drawing
// the strokes into the views, moving them and simplifying the graph, until nothing changes; and the
// same once more with what is found in the edgels that are left.
Reconstruction reconstruct(const Scene& scene, const ReconstructOptions& options,
                           Progress* progress) {
  RunReport report;
  report.warnings = scene.warnings;

  const std::unique_ptr<Detector> detector = make_detector(options);
  const EdgeWorld all = detect_scene(scene, detector.get(), options, &report, progress);
  const PosedStrokes posed = pose_and_fit(focus_on_object(all, options, &report, progress), options,
                                          &report, progress);
  const EdgeWorld& world = posed.world;
  Sketch sketch = drop_print(posed.sketch, world, *detector, &report, progress);

  const std::vector<EdgeTarget> targets = make_targets(world, options.optimize);
  for (int k = 0; k < options.rounds; ++k) {
    const Round round = run_round(sketch, world, targets, options, &report, progress);
    sketch = round.sketch;
    if (options.simplify && !round.changed) break;
  }
  sketch = look_again(sketch, world, targets, options, &report, progress);
  sketch = drop_print(sketch, world, *detector, &report, progress);
  sketch = finish_sketch(sketch, world, options, &report, progress);
  if (sketch.size() == 0)
    throw TooLittleError(scene.folder + ": expected curves on which the views agree, found none");
  const Sketch proposed = propose_hidden(sketch, world, &report);
  return {sketch, report, proposed, view_names(world),
          posed.refined ? world.views : std::vector<View>()};
}

}  // namespace sketchsplat
