// SPDX-License-Identifier: MIT
#include "pipelines/method/complete_sketch.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "pipelines/options/derived_options.h"
#include "sketches/curve/curve_chain.h"
#include "topology/core/passes.h"
#include "topology/solid/sharp_edges.h"

namespace sketchsplat {
namespace {

// Of the solids that were written for made parts so many are right, see docs/solid.md.
constexpr double kRightSolids = 0.98;
// Of the ends of edges between faces that are sure from where they were seen.
constexpr double kReachPx = 3;

// That an edge is one which only the solid tells of.
double implied_probability(const SolidSearch& found) {
  return kRightSolids / (1 + std::exp(-found.margin));
}

SharpEdges edges_of(const SolidSearch& found, const Sketch& sketch, const EdgeWorld& world,
                    const ReconstructOptions& options) {
  if (found.solid) return sharp_edges(found, options.inferred);
  return with_sure_edges(sketch, found, kReachPx * world.footprint);
}

// Pieces of one curve, as a stroke and the rest of it that was inferred, become one.
SharpEdges joined(SharpEdges edges, const EdgeWorld& world) {
  TopologyOptions options;
  options.footprint = world.footprint;
  PassResult merged = merge_collinear(edges.sketch, options);
  SharpEdges out;
  out.sketch = std::move(merged.sketch);
  out.bent = edges.bent;
  out.inferred.assign(out.sketch.size(), true);
  for (size_t s = 0; s < edges.inferred.size(); ++s)
    if (merged.remap.stroke[s] >= 0 && !edges.inferred[s])
      out.inferred[merged.remap.stroke[s]] = false;
  for (const int s : edges.now) out.now.push_back(s < 0 ? -1 : merged.remap.stroke[s]);
  return out;
}

// Cubics that were bent at their joints fit the edgels again.
Sketch polished(const Sketch& sketch, const EdgeWorld& world, const ReconstructOptions& options) {
  Sketch out = polish(sketch, world, last_polish(options));
  smooth_joints(&out);
  return out;
}

}  // namespace

FinishedSketch complete_sketch(FinishedSketch finished, SolidSearch* found, const EdgeWorld& world,
                               const MethodRun& run) {
  const ReconstructOptions& options = run.options;
  if (!found->solid && !(options.inferred && found->shell)) return finished;
  Stage stage("complete", run.log);
  const SharpEdges edges = joined(edges_of(*found, finished.sketch, world, options), world);
  if (edges.sketch.size() == 0) return finished;
  finished.sketch = edges.bent ? polished(edges.sketch, world, options) : edges.sketch;
  finished.kept = renumbered(std::move(finished.kept), edges.now);
  rename_doubtful(edges.now, found);
  std::vector<double> implied;
  for (const bool inferred : edges.inferred)
    implied.push_back(inferred ? implied_probability(*found) : 0);
  judge_strokes(world, options, implied, &finished);
  const auto count = std::count(edges.inferred.begin(), edges.inferred.end(), true);
  run.log.count("strokes_inferred", double(count));
  stage.result(std::to_string(count) + " edges inferred");
  return finished;
}

void rename_doubtful(const std::vector<int>& now, SolidSearch* found) {
  std::vector<int> doubtful;
  for (const int s : found->doubtful)
    if (now[s] >= 0) doubtful.push_back(now[s]);
  std::sort(doubtful.begin(), doubtful.end());
  doubtful.erase(std::unique(doubtful.begin(), doubtful.end()), doubtful.end());
  found->doubtful = std::move(doubtful);
}

}  // namespace sketchsplat
