// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "pipelines/base/run_report.h"
#include "pipelines/survey/observe.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// What tells edges of the object from accidents, of one stroke. Free of units and finite.
struct StrokeFeatures {
  double views = 0;       ///< that see it
  double view_share = 0;  ///< of all views
  double cover = 0;       ///< share of its samples that enough views see
  double support = 0;     ///< share of its samples with an edgel, mean over the views that see it
  double rms_px = 0, bias_px = 0, still = 0;  ///< see StrokeStats
  double scatter = 0;                         ///< rms over that of the scene
  double width = 0;                           ///< of its edgels over that of the scene's
  double contrast = 0;                        ///< strength of its edgels over that of the scene's
  double outline = 0;                         ///< share of its edgels on an outline
  double length_px = 0;
  double joined = 0;  ///< share of its ends where another stroke ends; 1 if it is closed
  double sigma = 0;   ///< its largest standard deviation, thousandths of the longest side
  double determined = 0;  ///< share of the directions of its shape that the images determine

  /// By name, in this order, as report.json shows them.
  Numbers named() const;
};

/// `observation`: of this sketch, whose evidence is filled but for the confidence.
std::vector<StrokeFeatures> stroke_features(const Sketch& sketch, const EdgeWorld& world,
                                            const StrokeObservation& observation);

/// Probability that a stroke is right: 90 % of it within 5 thousandths of the object's longest side
/// of a true edge. A logistic model of a few features, see confidence.cc for where its numbers are
/// from. `outlines`: whether the scene's edgels tell outlines from others (its images have masks).
double probability_of_edge(const StrokeFeatures& features, bool outlines);

/// Fills in the confidence of every stroke.
void record_confidence(const std::vector<StrokeFeatures>& features, Sketch* sketch);

/// The sketch without strokes less probable than `least`; those of unknown probability stay.
Sketch keep_confident(const Sketch& sketch, double least);

}  // namespace sketchsplat
