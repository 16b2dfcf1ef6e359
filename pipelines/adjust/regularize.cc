// SPDX-License-Identifier: MIT
#include "pipelines/adjust/regularize.h"

#include <algorithm>

#include "datasets/types/dense.h"
#include "pipelines/adjust/regularity_finder.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

// [px^2] What all views together leave unknown of a place on a stroke: never less than `floor`. And
// a view may be wrong about the whole of a stroke: many places are no better than one then, so that
// of each is multiplied by their number. 1.4826 median is the standard deviation of normal numbers;
// the stroke itself follows the views by about two of them.
double unknown_of(const StrokeStats& s, double floor_px) {
  const double aside = 1.4826 * s.bias_px;
  return floor_px * floor_px + s.samples * (aside * aside / std::max(1, s.views - 2));
}

// The quadratics of what was seen in squared standard deviations of the edgels, and of what they
// leave unknown: `floor_px` of every place, and what single views get wrong of a whole stroke.
SampleQuadratics whitened(const StrokeObservation& seen, double floor_px, double footprint) {
  const Matches& q = seen.matches;
  SampleQuadratics out{q.information, q.slope};
  for (size_t i = 0; i < q.information.size(); ++i) {
    const StrokeStats& stroke = seen.strokes[seen.layout.stroke[i]];
    const double unknown = unknown_of(stroke, floor_px) * footprint * footprint;
    const double scatter_px = std::max(q.sigma_px, stroke.rms_px);
    const auto es = eigen_symmetric(q.information[i]);
    const Vector3d values = es.values;
    Vector3d shrink = Vector3d::Zero();
    for (int k = 0; k < 3; ++k)
      if (values[k] > 1e-6 * values[2])
        shrink[k] = 1 / (scatter_px * scatter_px + unknown * values[k]);
    const Eigen::Matrix3d& v = es.vectors;
    out.information[i] = v * shrink.cwiseProduct(values.cwiseMax(0)).asDiagonal() * v.transpose();
    out.slope.col(i) = v * shrink.asDiagonal() * v.transpose() * q.slope.col(i);
  }
  return out;
}

// The same quadratics, at samples of the sketch that were moved there. `cost` becomes what the way
// cost.
SampleQuadratics moved_to(const Samples& to, const Samples& from, const SampleQuadratics& q,
                          double* cost) {
  SampleQuadratics out = q;
  *cost = 0;
  for (size_t i = 0; i < q.information.size(); ++i) {
    const Vector3d d = to.position.col(i) - from.position.col(i);
    out.slope.col(i) += q.information[i] * d;
    *cost += d.dot(q.information[i] * d) + 2 * d.dot(q.slope.col(i));
  }
  return out;
}

}  // namespace

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
