// SPDX-License-Identifier: MIT
#include "pipelines/reconstruct.h"

#include <cstdio>
#include <memory>

#include "datasets/errors.h"
#include "pipelines/detectors.h"
#include "pipelines/scene_tags.h"
#include "pipelines/stages.h"

namespace sketchsplat {

namespace {

// With the clock set that all stages look at.
ReconstructOptions started(ReconstructOptions options) {
  if (options.budget > 0)
    options.deadline = options.polish.deadline = options.optimize.deadline =
        Deadline(options.budget);
  return options;
}

void tell_stop(const ReconstructOptions& options, RunReport* report, Progress* progress) {
  if (!options.deadline.passed()) return;
  char text[120];
  std::snprintf(text, sizeof text, "the budget of %g s is used up: not all was refined",
                options.budget);
  warn(text, report, progress);
}

}  // namespace

// The method. Images become edgels, edgels points in space, points strokes; then rounds of drawing
// the strokes into the views, moving them and simplifying the graph, until nothing changes; and the
// same once more with what is found in the edgels that are left.
Reconstruction reconstruct(const Scene& scene, const ReconstructOptions& given,
                           Progress* progress) {
  const ReconstructOptions options = started(given);
  RunReport report;
  report.warnings = scene.warnings;

  std::vector<TagSquare> tags;
  if (options.tags) tags = measure_tags(scene, &report, progress);
  const std::unique_ptr<Detector> detector = make_detector(options);
  const EdgeWorld all = detect_scene(scene, detector.get(), tags, options, &report, progress);
  const EdgeWorld world = focus_on_object(all, options, &report, progress);
  const std::vector<EdgePoint> points = lift_scene(world, options, &report, progress);
  Sketch sketch = fit_strokes(points, world, options, &report, progress);
  sketch = drop_print(sketch, world, *detector, &report, progress);

  const std::vector<EdgeTarget> targets = make_targets(world, options.optimize);
  for (int k = 0; k < options.rounds && !options.deadline.passed(); ++k) {
    const Round round = run_round(sketch, world, targets, options, &report, progress);
    sketch = round.sketch;
    if (options.simplify && !round.changed) break;
  }
  sketch = look_again(sketch, world, targets, options, &report, progress);
  sketch = drop_print(sketch, world, *detector, &report, progress);
  sketch = finish_sketch(sketch, world, options, &report, progress);
  if (sketch.size() == 0)
    throw TooLittleError(scene.folder + ": expected curves on which the views agree, found none");
  tell_stop(options, &report, progress);
  const Sketch proposed = propose_hidden(sketch, world, &report);
  return {sketch, report, proposed, view_names(world), tags};
}

}  // namespace sketchsplat
