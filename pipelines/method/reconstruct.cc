// SPDX-License-Identifier: MIT
#include "pipelines/method/reconstruct.h"

#include <cstdio>
#include <memory>
#include <utility>

#include "datasets/readers/smaller_pictures.h"
#include "datasets/types/errors.h"
#include "pipelines/cameras/refine_poses.h"
#include "pipelines/detectors/detectors.h"
#include "pipelines/method/close_solid.h"
#include "pipelines/method/complete_sketch.h"
#include "pipelines/method/family_start.h"
#include "pipelines/method/scene_tags.h"
#include "pipelines/stages/stages.h"

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

// The method. Images, no larger than it takes, become edgels: without masks, those of the object
// that the cameras look at, whose silhouettes are told first. Edgels become points in space, points
// strokes, and these, with the points that structure from motion found, tell whether the cameras
// err; then rounds of moving the strokes (by what their drawings differ in, if asked, and by least
// squares) and simplifying the graph, until nothing changes; and the same once more with what is
// found in the edgels that are left. With siblings of the part, their family's strokes, moved onto
// the edgels, come first, and the rest is for edgels that are left. Strokes of things beside the
// object go. Then the edges that the strokes lead to expect, where the pictures show them. At last,
// the solid that the strokes bound, if they tell one that has all edges the pictures show, and its
// edges that none shows. Last, rounded edges go that came in as pieces or because others led to
// them.
Reconstruction reconstruct(const Scene& scene, Detector* detector, const ReconstructOptions& given,
                           Progress* progress) {
  const ReconstructOptions options = started(given);
  RunReport report;
  report.warnings = scene.warnings;

  std::vector<TagSquare> tags;
  if (options.tags) tags = measure_tags(scene, &report, progress);
  const Scene small =
      detector->takes_smaller_pictures() ? with_smaller_pictures(scene, options.least_side) : scene;
  EdgeWorld all = detect_scene(small, detector, tags, options, &report, progress);
  EdgeWorld near = focus_on_object(std::move(all), options, &report, progress);
  near = tell_silhouettes(small, *detector, std::move(near), options, &report, progress);
  const FamilyStart family = start_from_siblings(near, options, &report, progress);
  const ReconstructOptions last = options_after(family, options);
  const bool cold = family.sketch.size() == 0;
  const PosedStrokes posed = cold ? pose_and_fit(small, std::move(near), options, &report, progress)
                                  : PosedStrokes{std::move(near), family.sketch};
  const EdgeWorld& world = posed.world;
  Sketch sketch = posed.sketch;
  const std::vector<EdgeTarget> targets =
      cold ? make_targets(world, options.optimize) : std::vector<EdgeTarget>();
  if (cold) {
    sketch = drop_print(sketch, world, *detector, &report, progress);
    sketch = run_rounds(sketch, world, targets, options, &report, progress);
  }
  sketch = look_again(sketch, world, targets, last, &report, progress);
  sketch = drop_print(sketch, world, *detector, &report, progress);
  sketch = drop_things(sketch, world, &report, progress);
  const Sketch chosen = sketch;
  sketch = close_sketch(sketch, world, last, &report);
  const WithMissing most = add_missing_edges(sketch, world, last, &report, progress);
  FinishedSketch finished = finish_sketch(most, world, last, &report, progress);
  if (finished.sketch.size() == 0)
    throw TooLittleError(scene.folder + ": expected curves on which the views agree, found none");
  tell_stop(options, &report, progress);
  SolidSearch solid = close_solid(finished.sketch, world, *detector, options, &report, progress);
  finished = complete_sketch(std::move(finished), &solid, world, options, &report, progress);
  rename_doubtful(leave_out_doubtful({chosen, most.sketch}, world, options, &finished), &solid);
  report_sketch(finished, world, &report);
  const Blends blends = options.blends ? find_blends(finished.sketch, world, options) : Blends();
  return {finished.sketch,
          report,
          view_names(world),
          posed.refined ? at_full_size(world.views, small, scene) : std::vector<View>(),
          tags,
          solid,
          blends};
}

Reconstruction reconstruct(const Scene& scene, const ReconstructOptions& options,
                           Progress* progress) {
  return reconstruct(scene, make_detector(options).get(), options, progress);
}

}  // namespace sketchsplat
