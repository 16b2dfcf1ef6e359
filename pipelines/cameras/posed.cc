// SPDX-License-Identifier: MIT
#include "pipelines/cameras/posed.h"

#include <utility>

#include "datasets/types/errors.h"
#include "pipelines/options/derived_options.h"
#include "pipelines/survey/round_judge.h"

namespace sketchsplat {

Refit refit_by(const StrokeFit& fit, const MethodRun& run) {
  return [fit, run](Posed* posed) {
    posed->report = {};
    posed->round.clear();
    try {
      FirstStrokes first = fit(posed->world, {run.options, {&posed->report, run.log.progress}});
      posed->sketch = std::move(first.sketch), posed->nats = first.nats, posed->odds = first.odds;
      const RoundModel model = select_options(run.options).round;
      for (const double nats : round_nats(posed->sketch, posed->world, model))
        posed->round.push_back(nats > 0);
    } catch (const TooLittleError&) {
      posed->sketch = {}, posed->nats = 0;
    }
  };
}

Observation look(const Posed& posed, double reach_px) {
  MatchOptions match;
  match.reach_px = reach_px;
  match.quadratics = false;
  return without_strokes(observe(posed.sketch, posed.world, match, kCameraSpacingPx), posed.round);
}

bool stands_among_things(const EdgeWorld& world) { return bool(world.object.table); }

EdgeWorld refreshed(EdgeWorld world) {
  if (world.silhouettes) world.hull = hull_of(world);
  if (!world.has_masks()) return world;
  const ObjectRegion object = world.object;
  EdgeWorld out = make_edge_world(std::move(world.views), std::move(world.maps));
  out.object = object;
  if (!object.box.isEmpty()) out.bounds = object.box;
  return out;
}

}  // namespace sketchsplat
