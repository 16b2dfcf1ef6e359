// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace sketchsplat {

/// Odds before anything is looked at: of a round rather than an edge, and of an edge rather than an
/// accident of edgels. 0: not known.
struct PriorOdds {
  double round = 0, edge = 0;
};

/// Odds of one hypothesis to another before anything is looked at, under which the likelihood
/// ratios [nat] of all cases are the most probable (empirical Bayes; expectation and maximization,
/// which has one maximum here). `for_it`, `against`: cases that are known beforehand, above 0.
double most_probable_odds(const std::vector<double>& nats, double for_it, double against);

}  // namespace sketchsplat
