// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace sketchsplat {

/// The nats that of `tests` candidates, none of which is an edge, one exceeds `rate` times on
/// average. `nulls`: what candidates got of which it is known that they are no edges; beyond a high
/// quantile of these the tail is taken to be exponential. With fewer than sixteen of them, what
/// Markov's inequality says of likelihood ratios: log(tests / rate). At least log(1 / rate).
double alarm_threshold(std::vector<double> nulls, double tests, double rate);

}  // namespace sketchsplat
