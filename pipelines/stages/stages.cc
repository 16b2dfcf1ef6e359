// SPDX-License-Identifier: MIT
#include "pipelines/stages/stages.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "datasets/types/errors.h"
#include "edges/views/link.h"
#include "edges/views/unexplained.h"
#include "pipelines/detectors/detectors.h"
#include "pipelines/survey/confidence.h"
#include "pipelines/survey/observe.h"
#include "pipelines/survey/other_things.h"
#include "sketches/curve/curve_chain.h"
#include "sketches/fit/segment.h"

namespace sketchsplat {
namespace {

constexpr int kSecondViews = 3;      // that agree on a point where nothing else is
constexpr int kShortestRest = 8;     // edgels: shorter rests of chains are corners and noise
constexpr double kLonger = 3;        // times the shortest stroke: the shortest that comes late
constexpr double kPrintSpacing = 4;  // [px] of the points of strokes that a detector judges

struct Round {
  Sketch sketch;
  bool changed = false;  // the graph did; positions always do
};

Sketch initial_sketch(const std::vector<EdgePoint>& points, double footprint,
                      const ReconstructOptions& options) {
  const std::vector<EdgePoint> thin = thin_points(points, footprint);
  Sketch sketch;
  for (const PointChain& chain : link_points(thin, footprint)) {
    Eigen::Matrix3Xd position(3, chain.points.size()), tangent(3, chain.points.size());
    for (size_t i = 0; i < chain.points.size(); ++i) {
      position.col(i) = thin[chain.points[i]].position;
      tangent.col(i) = thin[chain.points[i]].tangent;
    }
    segment_chain(position, tangent, chain.closed, footprint, options.segment, &sketch);
  }
  return sketch;
}

void note_verdicts(const Sketch& sketch, const Selection& selection, Progress* progress) {
  if (!progress) return;
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
    progress->note(line);
  }
}

// The polish before the last one.
PolishOptions early(const ReconstructOptions& options) {
  PolishOptions polish = options.polish;
  if (!options.early_polish) polish.rounds = 0;
  return polish;
}

ExtentOptions extent_options(const ReconstructOptions& options) {
  ExtentOptions extent = options.extent;
  extent.box = options.box;
  if (options.detector == "2dgs-sn")
    extent.gap_price = std::max(extent.gap_price, options.surfel_gap_price);
  return extent;
}

Sketch grown(const Sketch& sketch, const EdgeWorld& world, const ReconstructOptions& options) {
  return polish(fit_extents(sketch, world, extent_options(options)), world, early(options));
}

// The graph that says what the edgels do in fewer words.
Simplified simpler_graph(const Sketch& sketch, const EdgeWorld& world,
                         const ReconstructOptions& options) {
  const Described described = describe(sketch, world, prices(options));
  TopologyOptions topology = options.topology;
  static_cast<DescriptionCost&>(topology) = described.cost;
  return simplify(sketch, topology, described.points);
}

// Chains of strokes in as few words as their edgels allow.
Round rewritten(const Sketch& sketch, const EdgeWorld& world, const ReconstructOptions& options) {
  if (!options.rechain.on) return {sketch, false};
  const Spliced spliced = splice(sketch, world, prices(options), options.splice);
  const Rechained r = rechain(spliced.sketch, world, options.segment, options.rechain);
  const bool changed = spliced.overlaps + spliced.gaps + r.changes > 0;
  return {changed ? polish(r.sketch, world, early(options)) : sketch, changed};
}

constexpr double kNoRound = 1e6;  // [px] as --least-round
constexpr const char *kOddsOfRound = "odds_of_round", *kOddsOfEdge = "odds_of_edge";

}  // namespace

SelectOptions select_options(const ReconstructOptions& options) {
  SelectOptions select = options.select;
  select.price = options.segment.price;
  select.place_sigma_px = options.rechain.sigma_px;
  // Surfels say less exactly than pictures where an edge is.
  const bool surfels = options.detector == "2dgs-sn";
  if (surfels)
    select.evidence.least_sigma_px = select.round.least_sigma_px = options.surfel_sigma_px;
  // Surfels round all edges: without pictures rounds cannot be told.
  if (surfels && !(options.surfel_snap_px > 0)) select.round.least_radius_px = kNoRound;
  return select;
}

FirstStrokes fit_strokes(const std::vector<EdgePoint>& points, const EdgeWorld& world,
                         const ReconstructOptions& options, RunReport* report, Progress* progress) {
  Stage stage("fit", 0, report, progress);
  const Sketch first =
      polish(initial_sketch(points, world.footprint, options), world, early(options));
  const Selection selection = select_strokes(first, world, select_options(options));
  report->counts.push_back({kOddsOfRound, selection.round_odds});
  report->counts.push_back({kOddsOfEdge, selection.edge_odds});
  note_verdicts(first, selection, progress);
  const Sketch& chosen = selection.sketch;
  report->counts.push_back({"strokes_lifted", double(first.size())});
  stage.result(std::to_string(chosen.size()) + " of " + std::to_string(first.size()) +
               " strokes stand");
  double nats = 0;
  for (int i = 0; i < first.size(); ++i)
    if (selection.remap.stroke[i] >= 0) nats += selection.nats[i];
  return {rewritten(grown(chosen, world, options), world, options).sketch, nats};
}

namespace {

// Without strokes that `drop` says are no edges of the object; `what` names them.
Sketch without(const Sketch& sketch, const std::vector<char>& drop, const std::string& what,
               const std::string& count, RunReport* report, Progress* progress) {
  std::vector<bool> keep(sketch.size(), true);
  for (int i = 0; i < sketch.size(); ++i) {
    keep[i] = !drop[i];
    if (keep[i] || !progress) continue;
    const char* kind = kind_name(sketch.strokes[i].kind);
    progress->note(std::string(kind) + " " + std::to_string(i) + " is " + what);
  }
  const Sketch out = keep_strokes(sketch, keep);
  const double dropped = sketch.size() - out.size();
  Numbers& counts = report->counts;
  const auto at = std::find_if(counts.begin(), counts.end(),
                               [&](const auto& known) { return known.first == count; });
  if (at != counts.end())
    at->second += dropped;
  else if (dropped > 0)
    counts.push_back({count, dropped});
  return out;
}

}  // namespace

Sketch drop_print(const Sketch& sketch, const EdgeWorld& world, const Detector& detector,
                  RunReport* report, Progress* progress) {
  const SampleLayout layout = plan_samples(sketch, kPrintSpacing * world.footprint);
  const Samples samples = evaluate_samples(sketch, layout);
  const std::vector<EdgeKind> kinds =
      detector.judge({samples.position, samples.tangent, layout.first});
  std::vector<char> drop(sketch.size());
  for (int i = 0; i < sketch.size(); ++i) {
    const auto begin = kinds.begin() + layout.first[i], end = kinds.begin() + layout.first[i + 1];
    drop[i] = std::count(begin, end, EdgeKind::kPrint) > std::count(begin, end, EdgeKind::kShape);
  }
  return without(sketch, drop, "print", "strokes_of_print", report, progress);
}

Sketch drop_things(const Sketch& sketch, const EdgeWorld& world, RunReport* report,
                   Progress* progress) {
  return without(sketch, of_other_things(sketch, world), "of another thing", "strokes_of_things",
                 report, progress);
}

namespace {

// As the first strokes had it, of which rounds and accidents had not been left out yet.
SelectOptions later(const RunReport& report, const ReconstructOptions& options) {
  SelectOptions select = select_options(options);
  for (const auto& [name, value] : report.counts) {
    if (name == kOddsOfRound) select.round_odds = value;
    if (name == kOddsOfEdge) select.edge_odds = value;
  }
  return select;
}

Round run_round(const Sketch& sketch, const EdgeWorld& world,
                const std::vector<EdgeTarget>& targets, const ReconstructOptions& options,
                RunReport* report, Progress* progress) {
  Stage stage("round " + std::to_string(report->rounds.size() + 1), 0, report, progress);
  const OptimizeResult moved = optimize(sketch, world, targets, options.optimize);
  Numbers row;
  if (options.optimize.steps > 0)
    row = {{"splats", double(moved.splats)},
           {"loss_before", moved.initial_loss},
           {"loss_after", moved.final_loss}};
  row.push_back({"strokes_before", double(sketch.size())});
  Round round{moved.sketch, false};
  if (options.simplify) {
    const Simplified simpler = simpler_graph(moved.sketch, world, options);
    for (const auto& [name, count] : simpler.counts.named()) row.push_back({name, double(count)});
    const Round written = rewritten(grown(simpler.sketch, world, options), world, options);
    const Selection chosen = select_strokes(written.sketch, world, later(*report, options));
    note_verdicts(written.sketch, chosen, progress);
    row.push_back({"unexplaining", double(chosen.changes)});
    round.changed = simpler.counts.total() > 0 || written.changed || chosen.changes > 0;
    round.sketch = chosen.sketch;
  }
  row.push_back({"strokes", double(round.sketch.size())});
  stage.result(std::to_string(round.sketch.size()) + " strokes");
  report->rounds.push_back(std::move(row));
  return round;
}

}  // namespace

Sketch run_rounds(Sketch sketch, const EdgeWorld& world, const std::vector<EdgeTarget>& targets,
                  const ReconstructOptions& options, RunReport* report, Progress* progress) {
  for (int k = 0; k < options.rounds && !options.deadline.passed(); ++k) {
    const Round round = run_round(sketch, world, targets, options, report, progress);
    sketch = round.sketch;
    if (options.simplify && !round.changed) break;
  }
  return sketch;
}

namespace {

EdgeWorld rest_of(const EdgeWorld& world, const Sketch& sketch) {
  const SampleLayout layout = plan_samples(sketch, 2 * world.footprint);
  const Samples samples = evaluate_samples(sketch, layout);
  EdgelFlags explained = no_edgels(world);
  explain(world, {samples.position, samples.tangent, layout.first}, {}, &explained);
  return unexplained(world, explained, kShortestRest);
}

}  // namespace

Sketch strokes_of_rest(const Sketch& sketch, const EdgeWorld& world,
                       const ReconstructOptions& options) {
  const EdgeWorld rest = rest_of(world, sketch);
  LiftOptions lift = options.lift;
  lift.min_views = std::min(lift.min_views, kSecondViews);
  const Sketch first =
      polish(initial_sketch(lift_edges(rest, lift), rest.footprint, options), rest, early(options));
  return rewritten(grown(first, rest, options), rest, options).sketch;
}

namespace {

// The sketch with what the rest of the edgels add to it.
Round with_rest(const Sketch& sketch, const EdgeWorld& world, const ReconstructOptions& options,
                RunReport* report, Progress* progress) {
  Stage stage("again", 0, report, progress);
  const Sketch more = strokes_of_rest(sketch, world, options);
  Sketch both = sketch;
  append_strokes(more, &both);
  const Selection chosen = select_strokes(both, world, later(*report, options));
  std::vector<bool> keep(both.size(), true);
  int added = 0;
  for (int i = sketch.size(); i < both.size(); ++i) {
    keep[i] = chosen.verdicts[i] == Verdict::kKept &&
              chosen.stats[i].length_px >= kLonger * options.select.min_length_px;
    added += keep[i];
  }
  report->counts.push_back({"strokes_lifted_again", double(more.size())});
  report->counts.push_back({"strokes_added", double(added)});
  stage.result(std::to_string(added) + " of " + std::to_string(more.size()) + " strokes stand");
  return {keep_strokes(both, keep), added > 0};
}

}  // namespace

Sketch look_again(const Sketch& sketch, const EdgeWorld& world,
                  const std::vector<EdgeTarget>& targets, const ReconstructOptions& options,
                  RunReport* report, Progress* progress) {
  if (!options.second_look || options.deadline.passed()) return sketch;
  const Round more = with_rest(sketch, world, options, report, progress);
  if (!more.changed || options.rounds == 0) return more.sketch;
  return run_round(more.sketch, world, targets, options, report, progress).sketch;
}

std::vector<std::string> view_names(const EdgeWorld& world) {
  std::vector<std::string> names;
  for (const View& view : world.views) names.push_back(view.name);
  return names;
}

}  // namespace sketchsplat
