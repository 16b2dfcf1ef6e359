// SPDX-License-Identifier: MIT
#include "pipelines/method/family_start.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <sstream>

#include "datasets/types/errors.h"
#include "pipelines/base/sketch_input.h"
#include "pipelines/method/family_fit.h"
#include "pipelines/options/derived_options.h"
#include "pipelines/survey/select.h"
#include "sketches/curve/curve.h"
#include "sketches/curve/sample.h"

namespace sketchsplat {
namespace {

constexpr int kFitViews = 8;      // that most steps of the fit look at
constexpr int kStarts = 3;        // that are followed to the end, at most
constexpr double kGood = 0.9;     // of the edgels explained: no other start is tried
constexpr double kForeign = 0.5;  // of the edgels explained by the best start: less, and none will
constexpr double kExplained = 0.8;  // of the edgels, at least, by a sibling
constexpr double kPromising = 0.7;  // of the edgels, at least, before strokes are set free
constexpr double kSeen = 0.6;       // of its length that the views show, at least
constexpr double kFreeReach = 3;    // [px] of edgels that pull at strokes that are set free
constexpr double kMostMoved = 6;    // [px] of a stroke by these: else it is another edge
constexpr double kFreeCover = 0.5;  // of a stroke that its views show, at least, to set it free

std::vector<Sketch> read_siblings(const std::string& paths, const std::string& folder) {
  std::vector<Sketch> out;
  std::istringstream lines(paths);
  for (std::string path; std::getline(lines, path);) {
    if (!folder.empty()) path = (std::filesystem::path(folder) / path).string();
    out.push_back(read_sketch(path));
    if (out.back().size() == 0) throw InputError(sketch_file(path), "a sketch with curves", "none");
  }
  return out;
}

struct Best {
  Sketch sketch;
  double explained = -1;
};

Best best_fit(const FamilyFit& fit) {
  Best best;
  const std::vector<Sibling> starts = fit.starts();
  for (size_t k = 0; k < std::min<size_t>(kStarts, starts.size()); ++k) {
    const Sketch sketch = fit.sketch(fit.fit(starts[k]));
    const double explained = fit.explained(sketch);
    if (explained > best.explained) best = {sketch, explained};
    if (best.explained > kGood || best.explained < kForeign) break;
  }
  return best;
}

// [px] By how much each stroke was moved, at its worst place.
std::vector<double> moves_px(const Sketch& from, const Sketch& to, double footprint) {
  const SampleLayout layout = plan_samples(from, kFreeReach * footprint);
  const Samples before = evaluate_samples(from, layout), after = evaluate_samples(to, layout);
  std::vector<double> out(from.size());
  for (int i = 0; i < layout.size(); ++i) {
    const double move = (after.position.col(i) - before.position.col(i)).norm() / footprint;
    out[layout.stroke[i]] = std::max(out[layout.stroke[i]], move);
  }
  return out;
}

// Every stroke on its own, if enough views see it and it did not move onto another edge; the others
// stay where the family's fit has them, but for the ends that they share.
struct Freed {
  Sketch sketch;
  std::vector<bool> free;
};
Freed set_free(const Sketch& fitted, const EdgeWorld& world, const ReconstructOptions& options) {
  PolishOptions wide = options.polish;
  wide.reach_px = kFreeReach;
  Freed out{polish(polish(fitted, world, wide), world, options.polish), {}};
  MatchOptions match;
  match.exclusive_between = true;
  match.quadratics = false;
  const StrokeObservation o =
      with_strokes(observe(out.sketch, world, match, options.polish.spacing_px), world, 1);
  const std::vector<double> moved = moves_px(fitted, out.sketch, world.footprint);
  std::vector<bool> holds(fitted.nodes.cols());  // node of a free stroke
  for (int s = 0; s < fitted.size(); ++s) {
    const Stroke& stroke = fitted.strokes[s];
    out.free.push_back(o.strokes[s].views >= options.select.sure_views &&
                       o.strokes[s].cover > kFreeCover && moved[s] < kMostMoved);
    for (const int n : {stroke.begin, stroke.end})
      if (n >= 0 && out.free[s]) holds[n] = true;
    for (int h = 0; h < num_handles(stroke.kind) && !out.free[s]; ++h)
      out.sketch.handles.col(stroke.handle + h) = fitted.handles.col(stroke.handle + h);
  }
  for (int n = 0; n < fitted.nodes.cols(); ++n)
    if (!holds[n]) out.sketch.nodes.col(n) = fitted.nodes.col(n);
  return out;
}

}  // namespace

FamilyStart start_from_siblings(const EdgeWorld& world, const MethodRun& run) {
  const ReconstructOptions& options = run.options;
  if (options.like.empty()) return {};
  Stage stage("family", run.log);
  const Family family = learn_family(read_siblings(options.like, options.like_folder));
  const FamilyFit fit(family, world, kFitViews);
  const Best best = best_fit(fit);
  run.log.count("family_siblings", double(family.siblings));
  run.log.count("family_numbers", double(family.mean.size()));
  run.log.count("family_edgels_fitted", best.explained);
  if (best.explained < kPromising) {
    run.log.count("family_followed", 0);
    stage.result("no sibling: " + std::to_string(std::lround(100 * best.explained)) +
                 " % of the edgels");
    return {};
  }
  const Freed freed = set_free(best.sketch, world, options);
  const Sketch& sketch = freed.sketch;
  SelectOptions select = select_options(options);
  for (int s = 0; s < sketch.size(); ++s) select.prior.push_back(family.log_odds(s));
  const Selection chosen = select_strokes(sketch, world, select);
  double length = 0, seen = 0;
  FamilyStart start{chosen.sketch, true};
  for (int s = 0; s < sketch.size(); ++s) {
    const double l = stroke_length(sketch, s);
    length += l;
    if (chosen.nats[s] > select.prior[s]) seen += l;
    start.all_free = start.all_free && (freed.free[s] || chosen.verdicts[s] != Verdict::kKept);
    if (!run.log.progress) continue;
    char line[200];
    std::snprintf(line, sizeof line, "%s %d is %s, %s: %.0f px, %d views, moves %.2f px, %.1f nat",
                  kind_name(sketch.strokes[s].kind), s, verdict_name(chosen.verdicts[s]),
                  freed.free[s] ? "free" : "held", chosen.stats[s].length_px, chosen.stats[s].views,
                  chosen.stats[s].bias_px, chosen.nats[s]);
    run.log.note(line);
  }
  const double explained = fit.explained(chosen.sketch);
  const bool is_sibling = explained >= kExplained && seen >= kSeen * length;
  run.log.count("family_edgels_explained", explained);
  run.log.count("family_length_seen", length > 0 ? seen / length : 0);
  run.log.count("family_followed", double(is_sibling));
  char said[120];
  std::snprintf(said, sizeof said, "%s: %.0f %% of the edgels, %d of %d strokes",
                is_sibling ? "a sibling" : "no sibling", 100 * explained, chosen.sketch.size(),
                sketch.size());
  stage.result(said);
  return is_sibling ? start : FamilyStart{};
}

ReconstructOptions options_after(const FamilyStart& family, ReconstructOptions options) {
  if (family.sketch.size() == 0) return options;
  options.rounds = 0;
  options.final_polish = options.final_polish && family.all_free;
  options.select.min_views = std::max(options.select.min_views, options.select.sure_views);
  return options;
}

}  // namespace sketchsplat
