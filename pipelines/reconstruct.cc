// SPDX-License-Identifier: MIT
#include "pipelines/reconstruct.h"

#include <memory>

#include "datasets/errors.h"
#include "pipelines/detectors.h"
#include "pipelines/stages.h"

namespace sketchsplat {

// The method. Images become edgels, edgels points in space, points strokes; then rounds of drawing
// the strokes into the views, moving them and simplifying the graph, until nothing changes; and the
// same once more with what is found in the edgels that are left.
Reconstruction reconstruct(const Scene& scene, Detector* detector,
                           const ReconstructOptions& options, Progress* progress) {
  RunReport report;
  report.warnings = scene.warnings;

  const EdgeWorld all = detect_scene(scene, detector, options, &report, progress);
  const EdgeWorld world = focus_on_object(all, options, &report, progress);
  const std::vector<EdgePoint> points = lift_scene(world, options, &report, progress);
  Sketch sketch = fit_strokes(points, world, options, &report, progress);
  sketch = drop_print(sketch, world, *detector, &report, progress);

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
  return {sketch, report, proposed, view_names(world)};
}

Reconstruction reconstruct(const Scene& scene, const ReconstructOptions& options,
                           Progress* progress) {
  return reconstruct(scene, make_detector(options).get(), options, progress);
}

}  // namespace sketchsplat
