// SPDX-License-Identifier: MIT
#include "pipelines/method/rounds.h"

#include <string>
#include <utility>

#include "pipelines/method/lift_and_fit.h"
#include "pipelines/options/derived_options.h"

namespace sketchsplat {
namespace {

constexpr double kLonger = 3;  // times the shortest stroke: the shortest that comes late

// The graph that describes the edgels at the least code length.
Simplified simpler_graph(const Sketch& sketch, const EdgeWorld& world,
                         const ReconstructOptions& options) {
  const Described described = describe(sketch, world, prices(options));
  TopologyOptions topology = options.topology;
  static_cast<DescriptionCost&>(topology) = described.cost;
  return simplify(sketch, topology, described.points);
}

}  // namespace

Rounds::Rounds(const EdgeWorld& world, const PriorOdds& odds, const MethodRun& run)
    : world_(world), odds_(odds), run_(run), targets_(make_targets(world, run.options.optimize)) {}

Rounds::Round Rounds::run_round(const Sketch& sketch) {
  const ReconstructOptions& options = run_.options;
  Stage stage("round " + std::to_string(run_.log.report->rounds.size() + 1), run_.log);
  const OptimizeResult moved = optimize(sketch, world_, targets_, options.optimize);
  Numbers row;
  if (options.optimize.steps > 0)
    row = {{"splats", double(moved.splats)},
           {"loss_before", moved.initial_loss},
           {"loss_after", moved.final_loss}};
  row.push_back({"strokes_before", double(sketch.size())});
  Round round{moved.sketch, false};
  if (options.simplify) {
    const Simplified simpler = simpler_graph(moved.sketch, world_, options);
    for (const auto& [name, count] : simpler.counts.named()) row.push_back({name, double(count)});
    Sketch longer = grown(simpler.sketch, world_, options);
    const bool rewritten = rewrite_chains(world_, options, &longer);
    const Selection chosen = select_strokes(longer, world_, select_options(options, odds_));
    note_verdicts(longer, chosen, run_.log);
    row.push_back({"unexplaining", double(chosen.changes)});
    round.changed = simpler.counts.total() > 0 || rewritten || chosen.changes > 0;
    round.sketch = chosen.sketch;
  }
  row.push_back({"strokes", double(round.sketch.size())});
  stage.result(std::to_string(round.sketch.size()) + " strokes");
  run_.log.report->rounds.push_back(std::move(row));
  return round;
}

Sketch Rounds::until_still(Sketch sketch) {
  for (int k = 0; k < run_.options.rounds && !run_.options.deadline.passed(); ++k) {
    Round round = run_round(sketch);
    sketch = std::move(round.sketch);
    if (run_.options.simplify && !round.changed) break;
  }
  return sketch;
}

Rounds::Round Rounds::with_rest(const Sketch& sketch) {
  Stage stage("again", run_.log);
  const Sketch more = strokes_of_rest(sketch, world_, run_.options);
  Sketch both = sketch;
  append_strokes(more, &both);
  const Selection chosen = select_strokes(both, world_, select_options(run_.options, odds_));
  std::vector<bool> keep(both.size(), true);
  int added = 0;
  for (int i = sketch.size(); i < both.size(); ++i) {
    keep[i] = chosen.verdicts[i] == Verdict::kKept &&
              chosen.stats[i].length_px >= kLonger * run_.options.select.min_length_px;
    added += keep[i];
  }
  run_.log.count("strokes_lifted_again", more.size());
  run_.log.count("strokes_added", added);
  stage.result(std::to_string(added) + " of " + std::to_string(more.size()) + " strokes stand");
  return {keep_strokes(both, keep), added > 0};
}

Sketch Rounds::second_look(const Sketch& sketch) {
  if (!run_.options.second_look || run_.options.deadline.passed()) return sketch;
  const Round more = with_rest(sketch);
  return more.changed && run_.options.rounds > 0 ? run_round(more.sketch).sketch : more.sketch;
}

}  // namespace sketchsplat
