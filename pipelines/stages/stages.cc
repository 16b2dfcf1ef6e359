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
#include "pipelines/survey/propose.h"
#include "sketches/curve/curve_chain.h"
#include "sketches/fit/segment.h"

namespace sketchsplat {
namespace {

constexpr int kSecondViews = 3;      // that agree on a point where nothing else is
constexpr int kShortestRest = 8;     // edgels: shorter rests of chains are corners and noise
constexpr double kLonger = 3;        // times the shortest stroke: the shortest that comes late
constexpr double kPrintSpacing = 4;  // [px] of the points of strokes that a detector judges
constexpr double kSmoother = 0.1;    // standard deviation of smooth joints at last

struct Round {
  Sketch sketch;
  bool changed = false;  // the graph did; positions always do
};

Sketch initial_sketch(const std::vector<EdgePoint>& points, double footprint,
                      const ReconstructOptions& options) {
  const std::vector<EdgePoint> thin = thin_points(points, footprint, options.link);
  Sketch sketch;
  for (const PointChain& chain : link_points(thin, footprint, options.link)) {
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

// One price and one least deviation for all that is described.
Prices prices(const ReconstructOptions& options) {
  return {options.segment.price, options.rechain.sigma_px};
}

RegularizeOptions regularize_options(const ReconstructOptions& options) {
  RegularizeOptions regularize = options.regularize;
  regularize.price = options.segment.price;
  regularize.sigma_px = options.rechain.sigma_px;
  const double degree = M_PI / 180;
  regularize.refine.smooth_angle = options.polish.smooth_deg * degree;
  regularize.refine.smooth_weight =
      std::pow(1 / (kSmoother * options.polish.smooth_sigma_deg * degree), 2);
  return regularize;
}

// The graph that says what the edgels do in fewer words.
Simplified simpler_graph(const Sketch& sketch, const EdgeWorld& world,
                         const ReconstructOptions& options) {
  const Described described = describe(sketch, world, prices(options));
  TopologyOptions topology = options.topology;
  static_cast<DescriptionCost&>(topology) = described.cost;
  return simplify(sketch, topology, described.points);
}

void count_regularities(const Regularized& regular, RunReport* report) {
  for (int k = 0; k < kRelationKinds; ++k) {
    const RelationKind kind = RelationKind(k);
    const auto is_kind = [kind](const Regularity& r) { return r.kind == kind; };
    const auto count = std::count_if(regular.kept.begin(), regular.kept.end(), is_kind);
    report->counts.push_back({std::string("regular_") + relation_name(kind), double(count)});
  }
  report->counts.push_back({"regular_nats_saved", regular.nats_saved});
  report->regularities = regular.kept;
}

// Chains of strokes in as few words as their edgels allow.
Round rewritten(const Sketch& sketch, const EdgeWorld& world, const ReconstructOptions& options) {
  if (!options.rechain.on) return {sketch, false};
  const Spliced spliced = splice(sketch, world, prices(options), options.splice);
  const Rechained r = rechain(spliced.sketch, world, options.segment, options.rechain);
  const bool changed = spliced.overlaps + spliced.gaps + r.changes > 0;
  return {changed ? polish(r.sketch, world, early(options)) : sketch, changed};
}

}  // namespace

SelectOptions select_options(const ReconstructOptions& options) {
  SelectOptions select = options.select;
  select.price = options.segment.price;
  select.place_sigma_px = options.rechain.sigma_px;
  // Surfels say less exactly than pictures where an edge is.
  if (options.detector == "2dgs-sn") select.evidence.least_sigma_px = options.surfel_sigma_px;
  return select;
}

Sketch fit_strokes(const std::vector<EdgePoint>& points, const EdgeWorld& world,
                   const ReconstructOptions& options, RunReport* report, Progress* progress) {
  Stage stage("fit", 0, report, progress);
  const Sketch first =
      polish(initial_sketch(points, world.footprint, options), world, early(options));
  const Selection selection = select_strokes(first, world, select_options(options));
  note_verdicts(first, selection, progress);
  const Sketch& chosen = selection.sketch;
  report->counts.push_back({"strokes_lifted", double(first.size())});
  stage.result(std::to_string(chosen.size()) + " of " + std::to_string(first.size()) +
               " strokes stand");
  return rewritten(grown(chosen, world, options), world, options).sketch;
}

Sketch drop_print(const Sketch& sketch, const EdgeWorld& world, const Detector& detector,
                  RunReport* report, Progress* progress) {
  const SampleLayout layout = plan_samples(sketch, kPrintSpacing * world.footprint);
  const Samples samples = evaluate_samples(sketch, layout);
  const std::vector<EdgeKind> kinds =
      detector.judge({samples.position, samples.tangent, layout.first});
  std::vector<bool> keep(sketch.size(), true);
  for (int i = 0; i < sketch.size(); ++i) {
    const auto begin = kinds.begin() + layout.first[i], end = kinds.begin() + layout.first[i + 1];
    keep[i] = std::count(begin, end, EdgeKind::kPrint) <= std::count(begin, end, EdgeKind::kShape);
    if (keep[i] || !progress) continue;
    const char* kind = kind_name(sketch.strokes[i].kind);
    progress->note(std::string(kind) + " " + std::to_string(i) + " is print");
  }
  const Sketch out = keep_strokes(sketch, keep);
  const double dropped = sketch.size() - out.size();
  Numbers& counts = report->counts;
  const auto at = std::find_if(counts.begin(), counts.end(),
                               [](const auto& count) { return count.first == "strokes_of_print"; });
  if (at != counts.end())
    at->second += dropped;
  else if (dropped > 0)
    counts.push_back({"strokes_of_print", dropped});
  return out;
}

namespace {

Round run_round(const Sketch& sketch, const EdgeWorld& world,
                const std::vector<EdgeTarget>& targets, const ReconstructOptions& options,
                RunReport* report, Progress* progress) {
  Stage stage("round " + std::to_string(report->rounds.size() + 1), 0, report, progress);
  const OptimizeResult moved = optimize(sketch, world, targets, options.optimize);
  Numbers row = {{"splats", double(moved.splats)},
                 {"loss_before", moved.initial_loss},
                 {"loss_after", moved.final_loss},
                 {"strokes_before", double(sketch.size())}};
  Round round{moved.sketch, false};
  if (options.simplify) {
    const Simplified simpler = simpler_graph(moved.sketch, world, options);
    for (const auto& [name, count] : simpler.counts.named()) row.push_back({name, double(count)});
    const Round written = rewritten(grown(simpler.sketch, world, options), world, options);
    const Selection chosen = select_strokes(written.sketch, world, select_options(options));
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

// The sketch with what the rest of the edgels add to it.
Round with_rest(const Sketch& sketch, const EdgeWorld& world, const ReconstructOptions& options,
                RunReport* report, Progress* progress) {
  Stage stage("again", 0, report, progress);
  const EdgeWorld rest = rest_of(world, sketch);
  LiftOptions lift = options.lift;
  lift.min_views = std::min(lift.min_views, kSecondViews);
  const Sketch first =
      polish(initial_sketch(lift_edges(rest, lift), rest.footprint, options), rest, early(options));
  const Sketch more = rewritten(grown(first, rest, options), rest, options).sketch;
  Sketch both = sketch;
  append_strokes(more, &both);
  const Selection chosen = select_strokes(both, world, select_options(options));
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

namespace {

// Relations among the strokes that stay.
void renumber(const std::vector<bool>& stays, std::vector<Regularity>* kept) {
  std::vector<int> now;
  int next = 0;
  for (const bool s : stays) now.push_back(s ? next++ : -1);
  for (Regularity& r : *kept) {
    for (int& s : r.strokes) s = now[s];
    r.strokes.erase(std::remove(r.strokes.begin(), r.strokes.end(), -1), r.strokes.end());
  }
  kept->erase(std::remove_if(kept->begin(), kept->end(),
                             [](const Regularity& r) { return r.strokes.size() < 2; }),
              kept->end());
}

// Fills in the confidence and drops what is less probable than wanted; says how many.
int drop_unsure(const StrokeObservation& observation, const EdgeWorld& world, double least,
                Sketch* sketch, std::vector<Regularity>* kept, RunReport* report) {
  const std::vector<StrokeFeatures> features = stroke_features(*sketch, world, observation);
  record_confidence(features, sketch);
  for (int i = 0; i < sketch->size(); ++i) {
    const double confidence = sketch->evidence[i].confidence;
    if (confidence < least) continue;
    report->strokes.push_back(features[i].named());
    report->strokes.back().push_back({"confidence", confidence});
  }
  const int before = sketch->size();
  std::vector<bool> stays;
  for (const Evidence& e : sketch->evidence) stays.push_back(!(e.confidence < least));
  renumber(stays, kept);
  *sketch = keep_confident(*sketch, least);
  if (before > 0 && sketch->size() == 0)
    throw TooLittleError("expected strokes as probable as --min-confidence, found " +
                         std::to_string(before) + " less probable ones");
  return before - sketch->size();
}

StrokeObservation observed(const Sketch& sketch, const EdgeWorld& world,
                           const ReconstructOptions& options, double* reach_px) {
  MatchOptions match;
  match.reach_px = 1.0;
  match.quadratics = false;
  *reach_px = match.reach_px;
  return with_strokes(observe(sketch, world, match, options.polish.spacing_px), world,
                      options.select.min_views);
}

// Strokes from `first` on that are edges more probably than not, and all before them. Contrast was
// seen where they are: with it anything may have come that edgels do not bear out.
Sketch without_improbable(Sketch sketch, int first, const EdgeWorld& world,
                          const ReconstructOptions& options, int* left) {
  constexpr double kProbable = 0.5;
  double reach_px;
  const StrokeObservation o = observed(sketch, world, options, &reach_px);
  record_evidence(o, world, reach_px, &sketch);
  record_confidence(stroke_features(sketch, world, o), &sketch);
  std::vector<bool> keep(sketch.size(), true);
  for (int s = first; s < sketch.size(); ++s) keep[s] = sketch.evidence[s].confidence >= kProbable;
  *left = int(std::count(keep.begin() + first, keep.end(), true));
  return keep_strokes(sketch, keep);
}

// The sketch with edges that it leads to expect where the pictures show them. Nothing without
// pictures: other detectors' edgels are of something else.
Sketch with_missing(const Sketch& sketch, const EdgeWorld& world, const ReconstructOptions& options,
                    RunReport* report, Progress* progress) {
  const bool pictures = std::any_of(world.maps.begin(), world.maps.end(),
                                    [](const EdgelMap& m) { return m.grey != nullptr; });
  if (!options.missing.on || !pictures || options.deadline.passed()) return sketch;
  Stage stage("missing", 0, report, progress);
  const MissingEdges missing = add_missing(sketch, world, options.missing);
  int added = int(missing.nats.size());
  const Sketch probable = added == 0
                              ? sketch
                              : without_improbable(missing.sketch, missing.sketch.size() - added,
                                                   world, options, &added);
  report->counts.push_back({"candidates", double(missing.candidates)});
  report->counts.push_back({"strokes_missing", double(added)});
  stage.result(std::to_string(added) + " of " + std::to_string(missing.candidates) +
               " candidates stand");
  if (added == 0) return sketch;
  CloseOptions close = options.close;
  close.round.least_turn = 2;  // nobody has seen more of them than what was added
  return close_graph(probable, world, prices(options), close).sketch;
}

}  // namespace

Sketch finish_sketch(const Sketch& sketch, const EdgeWorld& world,
                     const ReconstructOptions& options, RunReport* report, Progress* progress) {
  Closed closed = options.close.on && !options.deadline.passed()
                      ? close_graph(sketch, world, prices(options), options.close)
                      : Closed{sketch};
  closed.sketch = with_missing(closed.sketch, world, options, report, progress);
  Stage stage("polish", 0, report, progress);
  Sketch out = closed.sketch;
  Regularized regular;
  if (options.final_polish) {
    Observation last;
    PolishOptions smooth = options.polish;  // what is nearly one curve becomes one
    smooth.smooth_sigma_deg *= kSmoother;
    out = polish(closed.sketch, world, smooth, &last);
    if (options.regularize.on && last.layout.size() > 0 && !options.deadline.passed()) {
      regular = regularize(out, with_strokes(std::move(last), world, 1), world.footprint,
                           regularize_options(options));
      out = regular.sketch;
    }
  }
  smooth_joints(&out);
  double reach_px;
  const StrokeObservation o = observed(out, world, options, &reach_px);
  record_evidence(o, world, reach_px, &out);
  const int unsure = drop_unsure(o, world, options.min_confidence, &out, &regular.kept, report);
  report->counts.push_back({"strokes", double(out.size())});
  report->counts.push_back({"ends_joined", double(closed.joined)});
  report->counts.push_back({"lines_bridged", double(closed.bridged)});
  report->counts.push_back({"arcs_rounded", double(closed.rounded)});
  const std::vector<CurveChain> chains = curve_chains(out);
  const std::vector<int> curve = chain_of_strokes(chains, out.size());
  for (Regularity& r : regular.kept)
    for (int& s : r.strokes) s = curve[s];
  for (int s = 0; s < out.size(); ++s) report->strokes[s].push_back({"curve", double(curve[s])});
  count_regularities(regular, report);
  report->counts.push_back({"loose_ends", double(count_loose_ends(out, world.footprint))});
  report->counts.push_back({"unsure", double(unsure)});
  report->counts.push_back({"edgel_sigma_px", o.matches.sigma_px});
  report->counts.push_back({"footprint", world.footprint});
  stage.result(std::to_string(out.size()) + " strokes");
  return out;
}

Sketch propose_hidden(const Sketch& sketch, const EdgeWorld& world, RunReport* report) {
  const Sketch proposed = propose_edges(sketch, world);
  report->counts.push_back({"proposed", double(proposed.size())});
  return proposed;
}

std::vector<std::string> view_names(const EdgeWorld& world) {
  std::vector<std::string> names;
  for (const View& view : world.views) names.push_back(view.name);
  return names;
}

}  // namespace sketchsplat
