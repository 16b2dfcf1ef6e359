// SPDX-License-Identifier: MIT
#include "pipelines/options/derived_options.h"

#include <algorithm>
#include <cmath>

namespace sketchsplat {
namespace {

constexpr double kSmoother = 0.1;  // standard deviation of smooth joints at last
// [px] Standard deviation of the edgels of surfels about their edge, see EvidenceModel.
constexpr double kSurfelSigmaPx = 0.25;
// Of edges that surfels show, at least: print hides edges that it crosses.
constexpr double kSurfelGapPrice = 2;
// Reach of the last polish. What lies farther off is something else beside the stroke, to which a
// wider reach would draw it: the outline of a round that leaves an edge, as a rule.
constexpr double kNearPx = 0.3, kNear = 3;  // and in standard deviations

bool uses_surfels(const ReconstructOptions& options) { return options.detector == "2dgs-sn"; }

}  // namespace

Prices prices(const ReconstructOptions& options) {
  return {options.segment.price, options.rechain.sigma_px};
}

SelectOptions select_options(const ReconstructOptions& options, const PriorOdds& odds) {
  SelectOptions select = options.select;
  select.price = options.segment.price;
  select.place_sigma_px = options.rechain.sigma_px;
  select.round_odds = odds.round, select.edge_odds = odds.edge;
  // Surfels say less exactly than pictures where an edge is.
  if (uses_surfels(options))
    select.evidence.least_sigma_px = select.round.least_sigma_px = kSurfelSigmaPx;
  return select;
}

ExtentOptions extent_options(const ReconstructOptions& options) {
  ExtentOptions extent = options.extent;
  extent.box = options.box;
  if (uses_surfels(options)) extent.gap_price = std::max(extent.gap_price, kSurfelGapPrice);
  return extent;
}

PolishOptions early_polish(const ReconstructOptions& options) {
  PolishOptions polish = options.polish;
  if (!options.early_polish) polish.rounds = 0;
  return polish;
}

PolishOptions last_polish(const ReconstructOptions& options) {
  PolishOptions polish = options.polish;
  polish.smooth_sigma_deg *= kSmoother;
  polish.final_reach_px = kNearPx;
  polish.final_reach = kNear;
  return polish;
}

RegularizeOptions regularize_options(const ReconstructOptions& options) {
  RegularizeOptions regularize = options.regularize;
  regularize.price = options.segment.price;
  regularize.sigma_px = options.rechain.sigma_px;
  const double degree = M_PI / 180;
  regularize.refine.smooth_angle = options.polish.smooth_deg * degree;
  regularize.refine.smooth_weight =
      std::pow(1 / (kSmoother * options.polish.smooth_sigma_deg * degree), 2);
  return regularize;
}

}  // namespace sketchsplat
