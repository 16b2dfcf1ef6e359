// SPDX-License-Identifier: MIT
#include "pipelines/method/add_edges.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "pipelines/method/finish.h"
#include "pipelines/method/leave_out.h"
#include "pipelines/options/derived_options.h"
#include "pipelines/survey/confidence.h"
#include "pipelines/survey/round_judge.h"

namespace sketchsplat {
namespace {

constexpr int kSettleRounds = 3;  // of a polish that what was added needs

// Moves single strokes from `first` on onto their edgels; contrast locates them only to a pixel.
// Those of groups stay.
Sketch on_edgels(const Sketch& sketch, int first, const std::vector<int>& group,
                 const EdgeWorld& world, PolishOptions options) {
  options.rounds = kSettleRounds;
  const Sketch polished = polish(sketch, world, options);
  std::vector<ControlPoints> controls;
  for (int s = 0; s < sketch.size(); ++s)
    controls.push_back(control_points(s < first || group[s - first] >= 0 ? sketch : polished, s));
  return with_control_points(sketch, controls);
}

// Strokes from `first` on that are edges more probably than not, and all before them. Contrast was
// seen where they are: with it anything may have come that edgels do not bear out, and the borders
// of rounds. Those of a group bear one another out, and are edges or rounds all together: the one
// that looks most like an edge decides, with what was known of them before.
Sketch without_improbable(Sketch sketch, int first, const MissingEdges& missing,
                          const EdgeWorld& world, const ReconstructOptions& options, int* left) {
  const StrokeObservation o = with_evidence(world, options, &sketch);
  record_confidence(stroke_features(sketch, world, o), &sketch);
  const std::vector<double> nats = round_nats(sketch, world, options.select.round);
  std::vector<double> of_group(missing.known.size(), INFINITY);
  for (int s = first; s < sketch.size(); ++s) {
    const int g = missing.group[s - first];
    if (g >= 0) of_group[g] = std::min(of_group[g], nats[s] - missing.known[g]);
  }
  const double odds = odds_of_round({nats.begin(), nats.begin() + first});
  std::vector<bool> keep(sketch.size(), true);
  for (int s = first; s < sketch.size(); ++s) {
    const int g = missing.group[s - first];
    keep[s] = g >= 0 ? of_group[g] + std::log(odds) <= 0
                     : sketch.evidence[s].confidence >= kProbable && nats[s] <= 0;
  }
  *left = int(std::count(keep.begin() + first, keep.end(), true));
  return keep_strokes(sketch, keep);
}

}  // namespace

Sketch close_sketch(const Sketch& sketch, const EdgeWorld& world, const MethodRun& run) {
  const ReconstructOptions& options = run.options;
  const Closed closed = options.close.on && !options.deadline.passed()
                            ? close_graph(sketch, world, prices(options), options.close)
                            : Closed{sketch};
  run.log.count("ends_joined", closed.joined);
  run.log.count("lines_bridged", closed.bridged);
  run.log.count("arcs_rounded", closed.rounded);
  return closed.sketch;
}

WithMissing add_missing_edges(const Sketch& sketch, const EdgeWorld& world, const MethodRun& run) {
  const ReconstructOptions& options = run.options;
  const bool pictures = std::any_of(world.maps.begin(), world.maps.end(),
                                    [](const EdgelMap& m) { return m.grey != nullptr; });
  if (!options.missing.on || !pictures || options.deadline.passed()) return {sketch, {}, {}};
  Stage stage("missing", run.log);
  const MissingEdges missing = add_missing(sketch, world, options.missing);
  int added = int(missing.nats.size());
  Sketch probable = sketch;
  if (added > 0) {
    const int first = missing.sketch.size() - added;
    probable = on_edgels(missing.sketch, first, missing.group, world, options.polish);
    probable = without_improbable(probable, first, missing, world, options, &added);
    probable = drop_things(probable, world, run.log);
  }
  run.log.count("candidates", missing.candidates);
  run.log.count("strokes_missing", added);
  stage.result(std::to_string(added) + " of " + std::to_string(missing.candidates) +
               " candidates stand");
  if (added == 0) return {sketch, {}, {}};
  CloseOptions close = options.close;
  close.round.least_turn = 2;  // nobody has seen more of them than what was added
  return {close_graph(probable, world, prices(options), close).sketch, missing.corners,
          missing.rings};
}

}  // namespace sketchsplat
