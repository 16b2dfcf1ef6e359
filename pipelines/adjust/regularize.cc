// SPDX-License-Identifier: MIT
#include "pipelines/adjust/regularize.h"

#include "pipelines/adjust/regularity_finder.h"
#include "pipelines/adjust/whitened.h"

namespace sketchsplat {

Regularized regularize(const Sketch& sketch, const StrokeObservation& seen, double footprint,
                       const RegularizeOptions& options) {
  Regularized out;
  out.sketch = sketch;
  if (sketch.size() == 0) return out;
  const Samples now = evaluate_samples(sketch, seen.layout);
  double cost = 0;
  const SampleQuadratics q =
      moved_to(now, seen.samples, whitened(seen, options.sigma_px, footprint), &cost);
  const SketchQuadratic all = sketch_quadratic(sketch, seen.layout, q);
  const RefineSketchResult free = refine_sketch(sketch, seen.layout, q, options.refine);
  // It was decided on a linear view. If the whole is no shorter, relations of conics are to blame,
  // most likely, which bend most: the last ones.
  for (int stages = 7; stages > 0; --stages) {
    RegularityFinder finder(sketch, all, footprint, options);
    if (!finder.weigher().ok()) return out;
    finder.find(stages);
    Relations relations = finder.kept();
    if (relations.list.empty()) return out;
    const Samples linear = evaluate_samples(finder.weigher().sketch(), seen.layout);
    const SampleQuadratics there = moved_to(linear, now, q, &cost);
    const RefineSketchResult bound =
        refine_sketch(finder.weigher().sketch(), seen.layout, there, options.refine, &relations);
    const double saved = finder.weigher().gain() - (cost + bound.final_cost - free.final_cost) / 2;
    if (!(saved > 0)) continue;
    out.nats_saved = saved;
    out.sketch = bound.sketch;
    out.kept = finder.regularities();
    return out;
  }
  return out;
}

}  // namespace sketchsplat
