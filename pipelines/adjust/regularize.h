// SPDX-License-Identifier: MIT
// In: a sketch held against the edgels. Out: the sketch moved onto them, and to what its strokes
// have in common. This folder may not include anything of pipelines but base and survey.
#pragma once

#include <vector>

#include "pipelines/survey/observe.h"
#include "sketches/solve/refine_sketch.h"
#include "sketches/solve/relations.h"

namespace sketchsplat {

struct RegularizeOptions {
  bool on = true;
  double price = 3;        ///< [nat] of a parameter at the most
  double sigma_px = 0.15;  ///< [px] least standard deviation of what all views say of a place
  double soft_px = 0.05;   ///< [px] standard deviation of a relation at the most
  /// Multiplications that finding may cost, about: hundreds of strokes that have nothing in common
  /// would cost minutes. Beyond it, fewer kinds of relations are looked for, or none.
  double most_work = 3e8;
  double soft_share = 0.1;      ///< and as a share of that of the stroke itself
  double tangent_angle = 0.02;  ///< [rad] joints of arcs that turn less may be tangent
  RefineSketchOptions refine;   ///< its weights in squared standard deviations
};

struct Regularized {
  Sketch sketch;
  std::vector<Regularity> kept;
  double nats_saved = 0;  ///< by which the description became shorter
};

/// Finds what strokes have in common (parallel, perpendicular, coplanar, coaxial, equal radius,
/// mirrored, tangent) and lets them share it where that makes the description shorter. A parameter
/// that is shared need not be stated: that saves its price, or log(range / standard deviation) less
/// the log of the number of candidates and less the price, if that is less (vague agreement is
/// chance). The edgels then are explained worse by half the squared Mahalanobis distance of the
/// relation's residual, from the covariance of all control points, given the relations taken
/// before. What was taken is imposed on the least squares of the edgels with small standard
/// deviations, and kept if the whole is shorter indeed. `seen`: the sketch (or one a small move
/// before it) held against the edgels; `footprint`: world length of a pixel.
Regularized regularize(const Sketch& sketch, const StrokeObservation& seen, double footprint,
                       const RegularizeOptions& options);

}  // namespace sketchsplat
