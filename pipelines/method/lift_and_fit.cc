// SPDX-License-Identifier: MIT
#include "pipelines/method/lift_and_fit.h"

#include <algorithm>
#include <cstdio>

#include "datasets/types/errors.h"
#include "edges/views/link.h"
#include "edges/views/unexplained.h"
#include "pipelines/options/derived_options.h"
#include "pipelines/survey/explained.h"
#include "sketches/fit/segment.h"

namespace sketchsplat {
namespace {

constexpr int kSecondViews = 3;   // that agree on a point where nothing else is
constexpr int kShortestRest = 8;  // edgels: shorter rests of chains are corners and noise

Sketch initial_sketch(const std::vector<EdgePoint>& points, double footprint,
                      const SegmentOptions& options) {
  const std::vector<EdgePoint> thin = thin_points(points, footprint);
  Sketch sketch;
  for (const PointChain& chain : link_points(thin, footprint)) {
    Eigen::Matrix3Xd position(3, chain.points.size()), tangent(3, chain.points.size());
    for (size_t i = 0; i < chain.points.size(); ++i) {
      position.col(i) = thin[chain.points[i]].position;
      tangent.col(i) = thin[chain.points[i]].tangent;
    }
    segment_chain(position, tangent, chain.closed, footprint, options, &sketch);
  }
  return sketch;
}

// Curves of lifted points, moved onto the edgels.
Sketch first_curves(const std::vector<EdgePoint>& points, const EdgeWorld& world,
                    const ReconstructOptions& options) {
  return polish(initial_sketch(points, world.footprint, options.segment), world,
                early_polish(options));
}

Sketch completed(const Sketch& sketch, const EdgeWorld& world, const ReconstructOptions& options) {
  Sketch out = grown(sketch, world, options);
  rewrite_chains(world, options, &out);
  return out;
}

}  // namespace

std::vector<EdgePoint> lift_scene(const EdgeWorld& world, const MethodRun& run) {
  Stage stage("lift", run.log);
  std::vector<EdgePoint> points = lift_edges(world, run.options.lift);
  if (points.empty())
    throw TooLittleError("expected edges that several views see, found none that agree");
  run.log.count("points", double(points.size()));
  stage.result(std::to_string(points.size()) + " points");
  return points;
}

FirstStrokes fit_strokes(const std::vector<EdgePoint>& points, const EdgeWorld& world,
                         const MethodRun& run) {
  Stage stage("fit", run.log);
  const Sketch first = first_curves(points, world, run.options);
  const Selection selection = select_strokes(first, world, select_options(run.options));
  note_verdicts(first, selection, run.log);
  run.log.count("odds_of_round", selection.round_odds);
  run.log.count("odds_of_edge", selection.edge_odds);
  run.log.count("strokes_lifted", first.size());
  stage.result(std::to_string(selection.sketch.size()) + " of " + std::to_string(first.size()) +
               " strokes stand");
  FirstStrokes out{completed(selection.sketch, world, run.options), 0,
                   PriorOdds{selection.round_odds, selection.edge_odds}};
  for (int i = 0; i < first.size(); ++i)
    if (selection.remap.stroke[i] >= 0) out.nats += selection.nats[i];
  return out;
}

FirstStrokes lift_and_fit(const EdgeWorld& world, const MethodRun& run) {
  return fit_strokes(lift_scene(world, run), world, run);
}

Sketch strokes_of_rest(const Sketch& sketch, const EdgeWorld& world,
                       const ReconstructOptions& options) {
  const EdgeWorld rest = unexplained(world, edgels_along(sketch, world), kShortestRest);
  LiftOptions lift = options.lift;
  lift.min_views = std::min(lift.min_views, kSecondViews);
  return completed(first_curves(lift_edges(rest, lift), rest, options), rest, options);
}

Sketch grown(const Sketch& sketch, const EdgeWorld& world, const ReconstructOptions& options) {
  return polish(fit_extents(sketch, world, extent_options(options)), world, early_polish(options));
}

bool rewrite_chains(const EdgeWorld& world, const ReconstructOptions& options, Sketch* sketch) {
  const Spliced spliced = splice(*sketch, world, prices(options), options.splice);
  const Rechained r = rechain(spliced.sketch, world, options.segment, options.rechain);
  const bool changed = spliced.overlaps + spliced.gaps + r.changes > 0;
  if (changed) *sketch = polish(r.sketch, world, early_polish(options));
  return changed;
}

void note_verdicts(const Sketch& sketch, const Selection& selection, const RunLog& log) {
  if (!log.progress) return;
  for (int i = 0; i < sketch.size(); ++i) {
    if (selection.verdicts[i] == Verdict::kKept) continue;
    const StrokeStats& s = selection.stats[i];
    char line[200];
    std::snprintf(line, sizeof line,
                  "%s %d is %s: %.0f px, %d views, scatter %.2f px, moves %.2f px, width %.2f px, "
                  "cover %.2f, %.1f nat",
                  kind_name(sketch.strokes[i].kind), i, verdict_name(selection.verdicts[i]),
                  s.length_px, s.views, s.rms_px, s.bias_px, s.width_px, s.cover,
                  selection.nats[i]);
    log.note(line);
  }
}

}  // namespace sketchsplat
