// SPDX-License-Identifier: MIT
#include "pipelines/survey/prior_odds.h"

#include <cmath>

namespace sketchsplat {

double most_probable_odds(const std::vector<double>& nats, double for_it, double against) {
  constexpr int kRepeats = 50;
  const double all = for_it + against + double(nats.size());
  double odds = for_it / against;
  for (int k = 0; k < kRepeats; ++k) {
    double expected = for_it;
    for (const double n : nats) expected += 1 / (1 + std::exp(-n) / odds);
    odds = expected / (all - expected);
  }
  return odds;
}

}  // namespace sketchsplat
