// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "topology/core/draft.h"
#include "topology/core/passes.h"
#include "topology/core/refit.h"

namespace sketchsplat {

/// One curve in the place of two pieces, and the nodes that it ends in (-1 if closed).
struct Merge {
  int a = -1, b = -1;
  PlainCurve curve;
  int begin = -1, end = -1;
  double cost = 0;  ///< [nat] by which the description grows; the least is done first
};

/// Ties a fitted curve to its end nodes: a node that other strokes share stays and the curve
/// follows; any other node follows the curve. Nothing if it is longer than `max_length`, world
/// units, or if it makes the description no shorter. `degrees` as Draft::degrees.
std::optional<Merge> settle(const Draft& draft, const std::vector<int>& degrees, int a, int b,
                            const PlainCurve& fit, int begin, int end, double max_length,
                            const TopologyOptions& options);

/// Number of ends of pieces other than a and b at a node.
int others_at(const Draft& draft, const std::vector<int>& degrees, int node, int a, int b);

/// Samples of a piece as points for a fit, weighted by arc length times opacity.
Run run_of(const Piece& piece);
Run reversed(const Run& run);
/// Arc length from the begin to each sample, by the trapezoid rule.
Eigen::VectorXd arc_lengths(const CurveSamples& samples);

/// Proposes the union of two living pieces, or nothing.
using Propose = std::optional<Merge> (*)(const Draft& draft, const std::vector<int>& degrees, int a,
                                         int b, const TopologyOptions& options);
/// Rounds of: propose for all pairs whose boxes come within `reach`, then do the cheapest first
/// (each piece once per round), until nobody proposes.
void merge_pairs(Propose propose, double reach, const TopologyOptions& options, Draft* draft);

}  // namespace sketchsplat
