// SPDX-License-Identifier: MIT
#include "pipelines/method/reconstruct.h"

#include <cstdio>
#include <memory>
#include <utility>

#include "datasets/readers/smaller_pictures.h"
#include "datasets/types/errors.h"
#include "pipelines/cameras/refine_poses.h"
#include "pipelines/method/add_edges.h"
#include "pipelines/method/close_solid.h"
#include "pipelines/method/complete_sketch.h"
#include "pipelines/method/detect_object.h"
#include "pipelines/method/family_start.h"
#include "pipelines/method/finish.h"
#include "pipelines/method/leave_out.h"
#include "pipelines/method/lift_and_fit.h"
#include "pipelines/method/rounds.h"
#include "pipelines/method/scene_tags.h"

namespace sketchsplat {
namespace {

// With the clock set that all stages look at.
ReconstructOptions started(ReconstructOptions options) {
  if (options.budget > 0)
    options.deadline = options.polish.deadline = options.optimize.deadline =
        Deadline(options.budget);
  return options;
}

void report_stop(const MethodRun& run) {
  if (!run.options.deadline.passed()) return;
  char text[120];
  std::snprintf(text, sizeof text, "the budget of %g s is used up: not all was refined",
                run.options.budget);
  run.log.warn(text);
}

std::vector<std::string> names_of(const std::vector<View>& views) {
  std::vector<std::string> names;
  for (const View& view : views) names.push_back(view.name);
  return names;
}

}  // namespace

// The method.
Reconstruction reconstruct(const Scene& scene, Detector* detector, const ReconstructOptions& given,
                           Progress* progress) {
  const ReconstructOptions options = started(given);
  Reconstruction out;
  const MethodRun run{options, {&out.report, progress}};
  out.report.warnings = scene.warnings;

  // Detect: pictures, no larger than it takes, become edgels.
  if (options.tags) out.tags = measure_tags(scene, run.log);
  const Scene small =
      detector->takes_smaller_pictures() ? with_smaller_pictures(scene, options.least_side) : scene;
  EdgeWorld seen = detect_scene(small, detector, out.tags, run);

  // Find the object: without masks, that which the cameras look at, and its silhouettes.
  seen = focus_on_object(std::move(seen), run);
  seen = add_silhouettes(small, *detector, std::move(seen), run);

  // Lift edgels to points and fit strokes to these, and correct the cameras by the strokes; or
  // start from siblings of the part (--like), whose strokes need neither.
  const FamilyStart family = start_from_siblings(seen, run);
  const bool cold = family.sketch.size() == 0;
  const PosedStrokes posed = cold ? pose_and_fit(small, std::move(seen), lift_and_fit, run)
                                  : PosedStrokes{std::move(seen), family.sketch};
  const EdgeWorld& world = posed.world;
  const ReconstructOptions later = options_after(family, options);
  const MethodRun late{later, run.log};

  // Rounds of moving the strokes and simplifying their graph, and a second look at the edgels that
  // are left.
  Rounds rounds(world, posed.odds, late);
  Sketch sketch = posed.sketch;
  if (cold) sketch = rounds.until_still(drop_print(sketch, world, *detector, run.log));
  sketch = drop_print(rounds.second_look(sketch), world, *detector, run.log);
  const Sketch chosen = drop_things(sketch, world, run.log);

  // Close gaps, add the edges that the others lead to expect, and what regularities tie together.
  const WithMissing most = add_missing_edges(close_sketch(chosen, world, late), world, late);
  FinishedSketch finished = polish_and_regularize(most, world, late);
  if (finished.sketch.size() == 0)
    throw TooLittleError(scene.folder + ": expected curves on which the views agree, found none");
  report_stop(run);

  // The solid that the strokes bound, if it has all edges that the pictures show; its edges are the
  // sketch. Rounded edges go that came in as pieces, or because others led to them.
  out.solid = close_solid(finished.sketch, world, *detector, run);
  finished = complete_sketch(std::move(finished), &out.solid, world, run);
  rename_doubtful(leave_out_doubtful({chosen, most.sketch}, world, options, &finished), &out.solid);

  report_sketch(finished, world, run.log);
  if (options.blends) out.blends = find_blends(finished.sketch, world, options);
  out.sketch = std::move(finished.sketch);
  out.views = names_of(world.views);
  if (posed.refined) out.refined = at_full_size(world.views, small, scene);
  return out;
}

Reconstruction reconstruct(const Scene& scene, const ReconstructOptions& options,
                           Progress* progress) {
  return reconstruct(scene, make_detector(options).get(), options, progress);
}

}  // namespace sketchsplat
