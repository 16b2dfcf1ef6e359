// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "edges/views/match.h"
#include "sketches/curve/sample.h"

namespace sketchsplat {

/// What the edgels of all views say about one stroke.
struct StrokeStats {
  int samples = 0;
  int views = 0;         ///< in which it explains edgels
  double rms_px = 0;     ///< of its distances
  double bias_px = 0;    ///< median over the views of |median distance in a view|
  double still = 0;      ///< share of its edgels within 0.25 px of it
  double outline = 0;    ///< share of its edgels that lie on an outline
  double cover = 0;      ///< share of its samples that enough views see
  double width_px = 0;   ///< median width of its edgels
  double strength = 0;   ///< median strength of its edgels
  int matches = 0;       ///< edgels explained, all views
  double length_px = 0;  ///< its length over the footprint
};

/// A sketch held against the edgels.
struct Observation {
  double reach_px = 0;  ///< [px] within which it was matched
  SampleLayout layout;
  Samples samples;
  Matches matches;
};
/// With what it says about each stroke.
struct StrokeObservation : Observation {
  std::vector<StrokeStats> strokes;
};

/// Samples every `spacing_px` footprints.
Observation observe(const Sketch& sketch, const EdgeWorld& world, const MatchOptions& options,
                    double spacing_px);
/// The samples of one stroke.
CurvePoints points_of(const Observation& observation, int stroke);
/// Without the matches of strokes that are marked (one per stroke), and without quadratics.
Observation without_strokes(Observation observation, const std::vector<char>& leave);
/// `min_views` views make a sample covered.
StrokeObservation with_strokes(Observation observation, const EdgeWorld& world, int min_views);

/// Where the edgels of all views put the samples of a stroke, across it.
struct Measured {
  Eigen::Matrix3Xd point;    ///< 3 x samples; where too few views tell, the sample itself
  std::vector<char> placed;  ///< one per sample: do three views or more tell, within reach?
};
Measured measure(const Observation& observation, int stroke, double footprint);

/// The observation that places are measured by, and the standard deviation of such a place [px]: at
/// least `least_px`, which stands for what all views get wrong together.
Observation observe_places(const Sketch& sketch, const EdgeWorld& world);
double place_sigma_px(const Observation& observation, double least_px);

/// What it takes [nat] to say where a node is, among all places in the scene that can be told
/// apart.
double node_price(const EdgeWorld& world, double sigma_px);

/// What the edgels say about one stroke, but for those that are `ignored` (per view and edgel; may
/// be null). `cover` counts all.
StrokeStats summarise(const EdgeWorld& world, const Observation& observation, int stroke,
                      int min_views, const std::vector<std::vector<char>>* ignored);

/// Copies what was seen into the sketch's evidence (opacity = cover), with the covariance of every
/// stroke from the edgels it was matched with within `reach_px`. Not the confidence.
void record_evidence(const StrokeObservation& observation, const EdgeWorld& world, double reach_px,
                     Sketch* sketch);

}  // namespace sketchsplat
