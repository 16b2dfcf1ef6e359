// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "edges/views/unexplained.h"
#include "pipelines/survey/observe.h"

namespace sketchsplat {

/// How views show edges. Set by hand on candidate strokes of synthetic parts.
struct EvidenceModel {
  double sure_rate = 0.88;     ///< views that show an edge that nothing hides, by the hull
  double unsure_rate = 0.3;    ///< the same where something may hide it
  double miss = 0.57;          ///< likelihood ratio of a place without an edgel
  double accident = 0.02;      ///< edgels of an edge that lie anywhere
  double blurred = 0.2;        ///< edgels of no edge that are blurred by whatever made them
  double least_sigma_px = 0.1;  ///< [px] standard deviation of edgels about their edge, at least
  double least_width_sigma = 0.05;  ///< of the logarithm of the width of sharp edges
};

/// Standard deviation [px] of the distances of edgels from the strokes that many views see, with
/// all that cameras err; 0 if there is no such stroke. From the median: edgels of others do not
/// matter.
double scatter_px(const EdgeWorld& world, const Observation& every);

/// Judges the strokes of a sketch by the edgels of all views.
class StrokeJudge {
 public:
  /// `every`: the sketch, observed without exclusion and with min_run 0, within `reach_px`.
  /// `sigma_px`: standard deviation of edgels in this scene. All must outlive the judge.
  StrokeJudge(const EdgeWorld& world, const Observation& every, double reach_px, double sigma_px,
              const EvidenceModel& model);

  /// Logarithm of the likelihood ratio [nat] of an edge at the stroke's place and of none: the sum
  /// over the views of log(1 - p + p r), p the rate at which the view shows an edge that is there,
  /// r the mean over the stroke's places of what is found there: normal against uniform distances
  /// of an edgel, times how likely it is as wide as sharp edges here are, `miss` where there is
  /// none, 1 where the edgel is `others`' (per view and edgel; may be null). Places within a view
  /// are no independent witnesses, views are.
  double nats(int stroke, const EdgelFlags* others) const;

 private:
  struct InView {
    double inside = 0;  // share of the stroke's places that lie in the image
    double sure = 0;    // share of these that nothing hides
  };

  const EdgeWorld& world_;
  const Observation& every_;
  EvidenceModel model_;
  /// Likelihood ratio of an edgel so wide.
  double sharpness(float width_px) const;

  double sigma_, peak_;  // of the distances [px]; their density over the uniform one
  double log_width_ = 0, width_sigma_ = 0;  // of sharp edges
  std::vector<std::vector<InView>> in_view_;  // per stroke and view
};

}  // namespace sketchsplat
