// SPDX-License-Identifier: MIT
// In: strokes, and the edgels of all views. Out: what the views show of each stroke, and which are
// edges. This folder may not include anything of pipelines but base.
#pragma once

#include "edges/views/lift.h"
#include "pipelines/survey/likelihood.h"
#include "pipelines/survey/observe.h"
#include "pipelines/survey/round_judge.h"
#include "sketches/graph/sketch.h"
#include "topology/core/remap.h"

namespace sketchsplat {

struct SelectOptions {
  int min_views = 3;  ///< that must see a stroke by edgels no better stroke explains
  /// Strokes that fewer see are rare: they have odds of their own, beforehand, and of the views
  /// that see a rare line two make it, so that only the others are evidence.
  int sure_views = 4;
  double least_nats = 0;        ///< [nat] logarithm of its likelihood ratio, see likelihood.h
  double min_length_px = 4.0;   ///< [px]
  double price = 3;             ///< [nat] of a parameter, see SegmentOptions
  double place_sigma_px = 0.2;  ///< [px] see place_sigma_px
  EvidenceModel evidence;
  RoundModel round;
  /// Of a round rather than an edge beforehand; 0: as these strokes have it (odds_of_round). To be
  /// told where rounds have been left out already: what is left holds fewer than the scene does.
  double round_odds = 0;
  /// Of an edge rather than an accident of edgels, beforehand; 0: as these strokes have it
  /// (odds_of_edge). To be told where accidents have been left out already.
  double edge_odds = 0;
  /// [nat] log prior odds of strokes that are known from elsewhere, one per stroke, NaN: none. They
  /// add to the likelihood; neither their number of views nor their price counts, which those paid
  /// for who knew them first. Empty: of no stroke.
  std::vector<double> prior;
};

/// Why a stroke was not kept; the first reason that holds.
enum class Verdict {
  kKept,
  kShort,      ///< shorter than min_length_px
  kRound,      ///< the contour of a round surface, see rim.h
  kUnlikely,   ///< no edge: what the views show there is likelier without one
  kRedundant,  ///< better strokes explain its edgels
};
const char* verdict_name(Verdict verdict);

/// [nat] Logarithm of the odds of an edge, from its likelihood ratios [nat] to nothing and to a
/// round. `nothing` holds the odds of an edge to nothing beforehand; a round
/// is `round_odds` times as likely as an edge (odds_of_round).
double edge_nats(double nothing, double round, double round_odds);

/// Odds of an edge to an accident before the views are asked, under which these likelihood ratios
/// [nat] of a scene's strokes are likeliest: expectation and maximization, from one edge and
/// five accidents; at least 1 but for rare strokes. In clean pictures hardly any stroke is an
/// accident, and edges that few views show, as those of pockets, may stay.
double odds_of_edge(const std::vector<double>& nats, bool rare = false);

struct Selection : PassResult {
  double edge_odds = 0;            ///< that were used
  double rare_odds = 0;            ///< the same of rare strokes: as these strokes have it
  double round_odds = 0;           ///< that were used
  std::vector<Verdict> verdicts;   ///< one per stroke that came in
  std::vector<StrokeStats> stats;  ///< what the verdicts rest on
  std::vector<double> nats;        ///< of what no better stroke explains, and of the prior
};

/// Keeps the fewest strokes that explain the edgels: best supported first, a stroke stays if the
/// views show it, by what no stroke before it explains (likelihood.h), if it is no contour (rim.h),
/// and if the places where enough views see what no stroke before it explains would cost more
/// without it, as outliers, than its parameters and nodes do. A stroke that few views see meets
/// others' edgels in those that do not see it: where these would condemn it, it is judged by the
/// edgels alone that lie beside no better stroke.
Selection select_strokes(const Sketch& sketch, const EdgeWorld& world,
                         const SelectOptions& options);

}  // namespace sketchsplat
