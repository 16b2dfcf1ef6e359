// SPDX-License-Identifier: MIT
// The last stages: gaps closed, missing edges added, the last polish and choice.
#include <algorithm>
#include <cmath>

#include "datasets/types/errors.h"
#include "pipelines/adjust/polish_tangent.h"
#include "pipelines/stages/stages.h"
#include "pipelines/survey/confidence.h"
#include "pipelines/survey/observe.h"
#include "pipelines/survey/round_judge.h"
#include "sketches/curve/curve_chain.h"

namespace sketchsplat {
namespace {

// Views that show a stroke so wide, see WidthRates.
constexpr const char* kByWidth[] = {"views_narrow", "views_as_wide", "views_wide", "views_wider"};
constexpr double kSmoother = 0.1;  // standard deviation of smooth joints at last
// Reach of the last polish. What lies farther off is something else beside the stroke, to which a
// wider reach would draw it: the outline of a round that leaves an edge, as a rule.
constexpr double kNearPx = 0.3, kNear = 3;  // and in standard deviations
constexpr int kSettleRounds = 3;            // of a polish that what was added needs
constexpr double kProbable = 0.5;  // of an edge that something else than its edgels tells of

// What strokes are called when only some of them stay; -1 for the others.
std::vector<int> numbers_after(const std::vector<bool>& stays) {
  std::vector<int> now;
  int next = 0;
  for (const bool s : stays) now.push_back(s ? next++ : -1);
  return now;
}

// What two of the strokes that stay share, at least.
void renumber(const std::vector<int>& now, std::vector<Regularity>* kept) {
  for (Regularity& r : *kept) {
    for (int& s : r.strokes) s = now[s];
    r.strokes.erase(std::remove(r.strokes.begin(), r.strokes.end(), -1), r.strokes.end());
  }
  kept->erase(std::remove_if(kept->begin(), kept->end(),
                             [](const Regularity& r) { return r.strokes.size() < 2; }),
              kept->end());
}

// Fills in what the images say of each stroke.
StrokeObservation with_evidence(const EdgeWorld& world, const ReconstructOptions& options,
                                Sketch* sketch) {
  MatchOptions match;
  match.reach_px = 1.0;
  match.quadratics = false;
  StrokeObservation o = with_strokes(observe(*sketch, world, match, options.polish.spacing_px),
                                     world, options.select.sure_views);
  record_evidence(o, world, match.reach_px, sketch);
  return o;
}

// Of a stroke that no image shows.
Evidence unseen() {
  Evidence e;
  e.opacity = 0;
  return e;
}

// Strokes from `first` on, but those of groups, on edgels of theirs: contrast, which tells that
// they are there, is as good within a pixel.
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
// of rounds. Those of a group bear one another out, and are edges or rounds all together: what
// looks most like an edge tells it, and what of them was known before.
Sketch without_improbable(Sketch sketch, int first, const MissingEdges& missing,
                          const EdgeWorld& world, const ReconstructOptions& options, int* left) {
  const StrokeObservation o = with_evidence(world, options, &sketch);
  record_confidence(stroke_features(sketch, world, o), &sketch);
  const Observation wide = observe_rounds(sketch, world, 0);
  const RoundJudge rounds(world, wide, options.select.round);
  std::vector<double> nats, of_group(missing.known.size(), INFINITY);
  for (int s = 0; s < sketch.size(); ++s) {
    nats.push_back(rounds.nats(s, nullptr));
    const int g = s < first ? -1 : missing.group[s - first];
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

Sketch close_sketch(const Sketch& sketch, const EdgeWorld& world, const ReconstructOptions& options,
                    RunReport* report) {
  const Closed closed = options.close.on && !options.deadline.passed()
                            ? close_graph(sketch, world, prices(options), options.close)
                            : Closed{sketch};
  report->counts.push_back({"ends_joined", double(closed.joined)});
  report->counts.push_back({"lines_bridged", double(closed.bridged)});
  report->counts.push_back({"arcs_rounded", double(closed.rounded)});
  return closed.sketch;
}

WithMissing add_missing_edges(const Sketch& sketch, const EdgeWorld& world,
                              const ReconstructOptions& options, RunReport* report,
                              Progress* progress) {
  const bool pictures = std::any_of(world.maps.begin(), world.maps.end(),
                                    [](const EdgelMap& m) { return m.grey != nullptr; });
  if (!options.missing.on || !pictures || options.deadline.passed()) return {sketch, {}, {}};
  Stage stage("missing", 0, report, progress);
  const MissingEdges missing = add_missing(sketch, world, options.missing);
  int added = int(missing.nats.size());
  Sketch probable = sketch;
  if (added > 0) {
    const int first = missing.sketch.size() - added;
    probable = on_edgels(missing.sketch, first, missing.group, world, options.polish);
    probable = without_improbable(probable, first, missing, world, options, &added);
    probable = drop_things(probable, world, report, progress);
  }
  report->counts.push_back({"candidates", double(missing.candidates)});
  report->counts.push_back({"strokes_missing", double(added)});
  stage.result(std::to_string(added) + " of " + std::to_string(missing.candidates) +
               " candidates stand");
  if (added == 0) return {sketch, {}, {}};
  CloseOptions close = options.close;
  close.round.least_turn = 2;  // nobody has seen more of them than what was added
  return {close_graph(probable, world, prices(options), close).sketch, missing.corners,
          missing.rings};
}

PolishOptions last_polish(const ReconstructOptions& options) {
  PolishOptions polish = options.polish;
  polish.smooth_sigma_deg *= kSmoother;
  polish.final_reach_px = kNearPx;
  polish.final_reach = kNear;
  return polish;
}

namespace {

// Nodes of `before` at one of the places, which stay there if they have moved far.
void put_back(const Sketch& before, const std::vector<Eigen::Vector3d>& places, double footprint,
              Sketch* after) {
  if (after->nodes.cols() != before.nodes.cols()) return;
  for (Eigen::Index n = 0; n < before.nodes.cols(); ++n)
    for (const Eigen::Vector3d& place : places)
      if ((before.nodes.col(n) - place).norm() < footprint &&
          (after->nodes.col(n) - place).norm() > footprint)
        after->nodes.col(n) = place;
}

// Circles of `before` at one of the places, the same.
void put_back_rings(const Sketch& before, const std::vector<ControlPoints>& rings, double footprint,
                    Sketch* after) {
  if (after->size() != before.size()) return;
  const auto far = [&](const ControlPoints& a, const ControlPoints& b) {
    return (a.p[0] - b.p[0]).norm() > footprint ||
           std::abs(a.p[1].norm() - b.p[1].norm()) > footprint;
  };
  for (int s = 0; s < before.size(); ++s) {
    const Stroke &from = before.strokes[s], &to = after->strokes[s];
    if (from.kind != StrokeKind::kCircle || to.kind != StrokeKind::kCircle) continue;
    const ControlPoints now = control_points(before, s);
    const bool ring = std::any_of(rings.begin(), rings.end(),
                                  [&](const ControlPoints& r) { return !far(r, now); });
    if (ring && far(control_points(*after, s), now))
      for (int k = 0; k < num_handles(StrokeKind::kCircle); ++k)
        after->handles.col(to.handle + k) = before.handles.col(from.handle + k);
  }
}

}  // namespace

FinishedSketch finish_sketch(const WithMissing& all, const EdgeWorld& world,
                             const ReconstructOptions& options, RunReport* report,
                             Progress* progress) {
  Stage stage("polish", 0, report, progress);
  const Sketch& sketch = all.sketch;
  FinishedSketch out;
  out.sketch = sketch;
  if (options.final_polish) {
    Observation last;
    out.sketch = polish_tangent(sketch, world, last_polish(options), prices(options), &last);
    if (options.regularize.on && last.layout.size() > 0 && !options.deadline.passed()) {
      Regularized regular = regularize(out.sketch, with_strokes(std::move(last), world, 1),
                                       world.footprint, regularize_options(options));
      report->counts.push_back({"regular_nats_saved", regular.nats_saved});
      out.sketch = std::move(regular.sketch);
      out.kept = std::move(regular.kept);
    }
  }
  put_back(sketch, all.corners, world.footprint, &out.sketch);
  put_back_rings(sketch, all.rings, world.footprint, &out.sketch);
  smooth_joints(&out.sketch);
  judge_strokes(world, options, {}, &out);
  stage.result(std::to_string(out.sketch.size()) + " strokes");
  return out;
}

void judge_strokes(const EdgeWorld& world, const ReconstructOptions& options,
                   const std::vector<double>& implied, FinishedSketch* finished) {
  Sketch& sketch = finished->sketch;
  const StrokeObservation o = with_evidence(world, options, &sketch);
  const std::vector<StrokeFeatures> features = stroke_features(sketch, world, o);
  record_confidence(features, &sketch);
  for (size_t s = 0; s < implied.size(); ++s)
    if (sketch.evidence[s].confidence < implied[s]) {
      if (sketch.evidence[s].confidence < kProbable) sketch.evidence[s] = unseen();
      sketch.evidence[s].confidence = implied[s];
    }
  const Observation wide = observe_rounds(sketch, world, 0);
  const RoundJudge rounds(world, wide, options.select.round);
  finished->features.clear();
  for (int s = 0; s < sketch.size(); ++s) {
    finished->features.push_back(features[s].named());
    const std::array<int, 4> by_width = rounds.views_by_width(s, nullptr);
    for (int k = 0; k < 4; ++k)
      finished->features.back().push_back({kByWidth[k], double(by_width[k])});
    finished->features.back().push_back({"confidence", sketch.evidence[s].confidence});
  }
  finished->edgel_sigma_px = o.matches.sigma_px;
}

std::vector<int> leave_out_doubtful(const StrokeOrigins& origins, const EdgeWorld& world,
                                    const ReconstructOptions& options, FinishedSketch* finished) {
  const std::vector<bool> round =
      rounded_strokes(finished->sketch, origins, world, select_options(options));
  std::vector<bool> stays;
  std::vector<Numbers> features;
  int unsure = 0;
  for (int s = 0; s < finished->sketch.size(); ++s) {
    const bool sure = !(finished->sketch.evidence[s].confidence < options.min_confidence);
    stays.push_back(sure && !round[s]);
    unsure += !sure;
    if (stays.back()) features.push_back(std::move(finished->features[s]));
  }
  const std::vector<int> now = numbers_after(stays);
  renumber(now, &finished->kept);
  finished->features = std::move(features);
  const int before = finished->sketch.size();
  finished->sketch = keep_strokes(finished->sketch, stays);
  finished->unsure = unsure;
  finished->rounded = before - unsure - finished->sketch.size();
  if (before > 0 && finished->sketch.size() == 0)
    throw TooLittleError(unsure > 0 ? "expected strokes as probable as --min-confidence, found " +
                                          std::to_string(unsure) + " less probable ones"
                                    : "expected edges, found " + std::to_string(before) +
                                          " rounded ones alone");
  return now;
}

void report_sketch(const FinishedSketch& finished, const EdgeWorld& world, RunReport* report) {
  const Sketch& sketch = finished.sketch;
  report->strokes = finished.features;
  report->regularities = finished.kept;
  const std::vector<CurveChain> chains = curve_chains(sketch);
  const std::vector<int> curve = chain_of_strokes(chains, sketch.size());
  for (Regularity& r : report->regularities)
    for (int& s : r.strokes) s = curve[s];
  for (int s = 0; s < sketch.size(); ++s) report->strokes[s].push_back({"curve", double(curve[s])});
  report->counts.push_back({"strokes", double(sketch.size())});
  for (int k = 0; k < kRelationKinds; ++k) {
    const RelationKind kind = RelationKind(k);
    const auto is_kind = [kind](const Regularity& r) { return r.kind == kind; };
    const auto count = std::count_if(finished.kept.begin(), finished.kept.end(), is_kind);
    report->counts.push_back({std::string("regular_") + relation_name(kind), double(count)});
  }
  report->counts.push_back({"loose_ends", double(count_loose_ends(sketch, world.footprint))});
  report->counts.push_back({"unsure", double(finished.unsure)});
  report->counts.push_back({"rounded", double(finished.rounded)});
  report->counts.push_back({"edgel_sigma_px", finished.edgel_sigma_px});
  report->counts.push_back({"footprint", world.footprint});
}

}  // namespace sketchsplat
