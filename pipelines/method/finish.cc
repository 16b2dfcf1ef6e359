// SPDX-License-Identifier: MIT
#include "pipelines/method/finish.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "datasets/types/errors.h"
#include "pipelines/adjust/polish_tangent.h"
#include "pipelines/options/derived_options.h"
#include "pipelines/survey/confidence.h"
#include "pipelines/survey/round_judge.h"
#include "sketches/curve/curve_chain.h"

namespace sketchsplat {
namespace {

// Views that show a stroke so wide, see WidthRates.
constexpr const char* kByWidth[] = {"views_narrow", "views_as_wide", "views_wide", "views_wider"};

// Of a stroke that no image shows.
Evidence unseen() {
  Evidence e;
  e.opacity = 0;
  return e;
}

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

FinishedSketch polish_and_regularize(const WithMissing& all, const EdgeWorld& world,
                                     const MethodRun& run) {
  const ReconstructOptions& options = run.options;
  Stage stage("polish", run.log);
  FinishedSketch out;
  out.sketch = all.sketch;
  if (options.final_polish) {
    Observation last;
    out.sketch = polish_tangent(all.sketch, world, last_polish(options), prices(options), &last);
    if (options.regularize.on && last.layout.size() > 0 && !options.deadline.passed()) {
      Regularized regular = regularize(out.sketch, with_strokes(std::move(last), world, 1),
                                       world.footprint, regularize_options(options));
      run.log.count("regular_nats_saved", regular.nats_saved);
      out.sketch = std::move(regular.sketch);
      out.kept = std::move(regular.kept);
    }
  }
  put_back(all.sketch, all.corners, world.footprint, &out.sketch);
  put_back_rings(all.sketch, all.rings, world.footprint, &out.sketch);
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

std::vector<Regularity> renumbered(std::vector<Regularity> kept, const std::vector<int>& now) {
  for (Regularity& r : kept) {
    std::vector<int> strokes;
    for (const int s : r.strokes)
      if (now[s] >= 0 && std::find(strokes.begin(), strokes.end(), now[s]) == strokes.end())
        strokes.push_back(now[s]);
    r.strokes = std::move(strokes);
  }
  kept.erase(std::remove_if(kept.begin(), kept.end(),
                            [](const Regularity& r) { return r.strokes.size() < 2; }),
             kept.end());
  return kept;
}

std::vector<int> leave_out_doubtful(const StrokeOrigins& origins, const EdgeWorld& world,
                                    const ReconstructOptions& options, FinishedSketch* finished) {
  const std::vector<bool> round =
      rounded_strokes(finished->sketch, origins, world, select_options(options));
  std::vector<bool> stays;
  std::vector<int> now;
  std::vector<Numbers> features;
  int unsure = 0;
  for (int s = 0; s < finished->sketch.size(); ++s) {
    const bool sure = !(finished->sketch.evidence[s].confidence < options.min_confidence);
    stays.push_back(sure && !round[s]);
    unsure += !sure;
    now.push_back(stays.back() ? int(features.size()) : -1);
    if (stays.back()) features.push_back(std::move(finished->features[s]));
  }
  finished->kept = renumbered(std::move(finished->kept), now);
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

void report_sketch(const FinishedSketch& finished, const EdgeWorld& world, const RunLog& log) {
  const Sketch& sketch = finished.sketch;
  log.report->strokes = finished.features;
  log.report->regularities = finished.kept;
  const std::vector<CurveChain> chains = curve_chains(sketch);
  const std::vector<int> curve = chain_of_strokes(chains, sketch.size());
  for (Regularity& r : log.report->regularities)
    for (int& s : r.strokes) s = curve[s];
  for (int s = 0; s < sketch.size(); ++s)
    log.report->strokes[s].push_back({"curve", double(curve[s])});
  log.count("strokes", sketch.size());
  for (int k = 0; k < kRelationKinds; ++k) {
    const RelationKind kind = RelationKind(k);
    const auto is_kind = [kind](const Regularity& r) { return r.kind == kind; };
    const auto count = std::count_if(finished.kept.begin(), finished.kept.end(), is_kind);
    log.count(std::string("regular_") + relation_name(kind), count);
  }
  log.count("loose_ends", count_loose_ends(sketch, world.footprint));
  log.count("unsure", finished.unsure);
  log.count("rounded", finished.rounded);
  log.count("edgel_sigma_px", finished.edgel_sigma_px);
  log.count("footprint", world.footprint);
}

}  // namespace sketchsplat
