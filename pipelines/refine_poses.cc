// SPDX-License-Identifier: MIT
#include "pipelines/refine_poses.h"

#include <cstdio>
#include <chrono>
#include "edges/recast.h"
#include "pipelines/camera_fit.h"
#include "pipelines/options.h"
#include "pipelines/polish.h"
#include "pipelines/stages.h"

namespace sketchsplat {
void probe_poses(const Sketch& sketch, const EdgeWorld& world, const ReconstructOptions&,
                 Progress*) {
  Sketch now = sketch;
  EdgeWorld w = world;
  CameraPrior prior;
  prior.focal = 0.03;
  const std::vector<View> stated = world.views;
  int round = 0;
  for (double reach : {2.0, 2.0, 1.5, 1.5, 1.0, 1.0, 1.0, 1.0}) {
    MatchOptions match;
    match.reach_px = reach;
    match.quadratics = false;
    const Observation o = observe(now, w, match, 6);
    const CameraFit f = fit_cameras(now, o, w, stated, prior, round == 0 ? 2 : 4);
    std::fprintf(stderr, "probe %d reach %.1f rows %zu offsets %d unknowns %d scatter %.3f offset %.3f -> %.3f focal %+.3f%% +- %.3f%% r %.0f\n",
      round, reach, o.matches.matches.size(), f.offsets, f.unknowns, f.scatter_px, f.before_px, f.after_px, 100*f.focal[0], 100*f.focal_sigma[0], f.radius_px[0]);
    now = f.sketch;
    w = recast(w, f.views);
    ++round;
  }
}
}  // namespace sketchsplat
