// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace sketchsplat {

/// The nats that of `tests` candidates, none of which is an edge, one exceeds `rate` times on
/// average. `nulls`: what candidates got of which it is known that they are no edges. The tail is
/// taken to be exponential, beyond a high quantile of these or above 0, whichever says less; with
/// less than four above 0, or sixteen in all, that is what Markov's inequality says of likelihood
/// ratios: log(tests / rate). At least log(1 / rate).
double alarm_threshold(std::vector<double> nulls, double tests, double rate);

}  // namespace sketchsplat
