// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <vector>

#include "edges/views/unexplained.h"
#include "pipelines/survey/observe.h"

namespace sketchsplat {

/// How often views show a stroke narrower than most edges, as wide as these, wider, or much wider:
/// parameters of a Dirichlet distribution of the four rates. What makes one edge wide in one view
/// (a curved face beside it, another edge) does so in many: its views are no independent witnesses.
using WidthRates = std::array<double, 4>;

/// How edges and rounds (fillets, bends, round corners) show: the likeliest parameters of widths on
/// candidate strokes of synthetic parts (eval/calibrate_likelihood.py estimates them on those that
/// are drawn), the rest set by hand on such strokes.
struct RoundModel {
  double least_radius_px = 2;  ///< [px] rounds of a smaller radius are edges
  double least_radius = 0;     ///< [world units] the same; 0: least_radius_px tells
  double accident = 0.15;      ///< views in which something else lies beside a stroke
  double witnesses = 0.4;      ///< of a view, as to where strokes lie: neighbours see alike
  WidthRates edge_widths = {1.11, 8.61, 0.60, 0.52};
  WidthRates round_widths = {0.78, 0.51, 0.29, 0.78};
  double least_sigma_px = 0.05;     ///< [px] standard deviation of an edge's median place in a view
  double least_width_sigma = 0.03;  ///< of the logarithm of the median width in a view
  double slack_px = 0.3;            ///< [px] standard deviation of a stroke about its edge
};

/// What one view shows along a stroke: medians over its samples.
struct RoundSighting {
  int view = 0;
  double place_px = 0;  ///< where its edgels lie, along the normal of line of sight and tangent
  double log_width = 0;
  bool outline = false;
  /// Change of the place by moves of the stroke along its two normals [px / px], and by the radius
  /// of a round whose axis the stroke is: 1 or -1 times the scale, away from the brighter side.
  Eigen::Vector3d row = Eigen::Vector3d::Zero();
};

/// The observation that a RoundJudge takes: of all that lies beside strokes, alone or not, within
/// `least_reach_px` or what a round needs.
Observation observe_rounds(const Sketch& sketch, const EdgeWorld& world, double least_reach_px);

/// Tells rounds from edges. An edge lies at one place in all views and is everywhere as wide as the
/// blur of the pictures has it. A round is a band: in some views it is the outline, where lines of
/// sight touch it, and that place moves with the view; in others its shading is strongest somewhere
/// across it, and wider or, where noise decides, narrower than an edge. How far places move and how
/// wide edgels are is a matter of the radius alone, so that small rounds become edges gradually.
class RoundJudge {
 public:
  /// `wide`: see observe_rounds. How exactly edges lie and how wide they are is estimated from
  /// those strokes that say so most clearly. Both must outlive the judge.
  RoundJudge(const EdgeWorld& world, const Observation& wide, const RoundModel& model);

  /// Logarithm of the likelihood ratio [nat] of a round and of an edge, without the edgels that are
  /// `others`' (per view and edgel; may be null). 0 without views.
  double nats(int stroke, const EdgelFlags* others) const;

  /// Radius of a round [px] with its standard deviation, and the views whose outlines tell it.
  struct Radius {
    double px = 0, sigma_px = 0;  // 0: nothing tells
    int views = 0;
  };
  /// Of the cylinder that lines of sight touch where a stroke runs, in more than three views.
  Radius radius(int stroke, const EdgelFlags* others) const;
  /// Views that show a stroke as each of WidthRates, outlines left out.
  std::array<int, 4> views_by_width(int stroke, const EdgelFlags* others) const;

  double sigma_px() const { return sigma_; }
  /// Logarithm of the width of sharp edges in a view [px]: its blur, and that of the detector.
  double log_width(int view) const { return log_width_[view]; }

 private:
  struct Places {
    double sigma_px, reach_px, accident;  // [px], [px], share of the views
    double near(double off_px) const;
  };
  Places places() const { return {sigma_, reach_, model_.accident}; }
  double places_of_edge(const std::vector<RoundSighting>& seen, const Places& places) const;
  double places_of_band(const std::vector<RoundSighting>& seen) const;
  struct RimFit {
    Eigen::Vector3d x;          // [px] axis, relative to the stroke, and radius
    Eigen::Matrix3d precision;  // [1 / px^2]
  };
  RimFit fit_rim(const std::vector<RoundSighting>& seen, double radius_px) const;
  double places_of_rim(const std::vector<RoundSighting>& seen) const;
  double nats_of_rim(const std::vector<RoundSighting>& seen, const RimFit& rim,
                     const Places& places) const;
  std::vector<RimFit> rims_through(const std::vector<RoundSighting>& seen, double reach_px) const;
  double nats_of_outlines(int stroke) const;
  double nats_of_outlines(const CurvePoints& curve, double reach_px) const;
  std::array<int, 4> by_width(const std::vector<RoundSighting>& seen) const;
  double widths_of_round(const std::vector<RoundSighting>& seen) const;
  const EdgeWorld& world_;
  const Observation& wide_;
  RoundModel model_;
  void learn_widths(const std::vector<std::vector<RoundSighting>>& strokes);
  void learn_rate(const std::vector<std::vector<RoundSighting>>& strokes);

  double reach_, sigma_;
  std::vector<double> log_width_;  // per view
  double width_sigma_ = 0;         // 0: nothing tells how wide edges are
  std::vector<double> outlines_;   // [nat] of a round, by all outlines near a stroke
};

/// RoundJudge::nats of every stroke of a sketch.
std::vector<double> round_nats(const Sketch& sketch, const EdgeWorld& world,
                               const RoundModel& model);

/// Odds of a round rather than an edge before a stroke is looked at, from the likelihood ratios
/// [nat] of all strokes of a scene: where all others are sharp, this one hardly is a round
/// (empirical Bayes). The most probable ones, at most those without strokes: one half.
double odds_of_round(const std::vector<double>& nats);

/// Where outlines run beside a curve, up to `reach_px` away: for every view and piece of the curve
/// that turns little, the median over its samples; widths stay 0. `curve`: one curve, two samples
/// or more.
struct Outlines {
  std::vector<RoundSighting> seen;
  int pieces = 1;  ///< of the curve
};
Outlines outlines_beside(const EdgeWorld& world, const CurvePoints& curve, double reach_px);

/// What the views show along a stroke that show enough of it.
std::vector<RoundSighting> round_sightings(const EdgeWorld& world, const Observation& wide,
                                           int stroke, const EdgelFlags* others);

}  // namespace sketchsplat
