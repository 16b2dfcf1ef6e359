// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "eval/inspect/association.h"
#include "eval/inspect/prior.h"
#include "eval/inspect/sigma_model.h"
#include "eval/inspect/tolerance.h"

namespace sketchsplat {

/// In: P >= 0.95; out: P <= 0.05. What is not visible is not judged.
enum class Judgement { kIn, kOut, kUndecided, kNotJudged };
const char* verdict_name(Judgement verdict);  ///< "in", "out", "undecided", "not judged"
Judgement verdict_of(double probability);
constexpr double kSure = 0.95;

/// How a nominal edge fared. Lengths in the nominal's unit.
struct EdgeCheck {
  Presence presence = Presence::kMissing;
  double found = 0, visible = 1;          ///< shares of its length
  double mean = 0, p95 = 0, largest = 0;  ///< deviation across the edge, over its length
  double sigma = 0;                       ///< largest of a place, from the edgels
  double systematic = 0;                  ///< the same, from what edgels do not know
  bool open = false;                  ///< a stroke of it has a direction that no edgel determines
  TubeProbability within;             ///< of what was found
  std::vector<double> largest_drawn;  ///< kDraws largest deviations, ascending; empty if none
  /// Probability that what was measured lies within the tolerance of what is there, whatever is
  /// nominal: whether the measurement can tell at all.
  double known = 0;
  double tolerance = 0;  ///< radius of the tube
  Judgement verdict = Judgement::kUndecided;
};

/// An edge before it is judged.
struct MeasuredEdge {
  EdgeCheck check;                      ///< without probabilities
  std::vector<PieceLikelihood> pieces;  ///< one per stroke beside it
};
MeasuredEdge measure_edge(const EdgeMatch& match, const NominalEdge& edge, const Sketch& measured,
                          bool held, double tolerance, const SigmaModel& sigma);

/// What the edges of a part say of its deviations; `learn`: or nothing.
DeviationPrior prior_of(const std::vector<MeasuredEdge>& edges, double tolerance, bool learn);

EdgeCheck judge_edge(const MeasuredEdge& edge, const DeviationPrior& prior);

}  // namespace sketchsplat
