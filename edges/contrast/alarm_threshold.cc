// SPDX-License-Identifier: MIT
#include "edges/contrast/alarm_threshold.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace sketchsplat {
namespace {

// What of `tests` `rate` exceed, if those of the highest `top` that lie above `base` end
// exponentially.
double by_tail(const std::vector<double>& descending, size_t top, double base, double tests,
               double rate) {
  double mean = 0;
  for (size_t k = 0; k < top; ++k) mean += (descending[k] - base) / double(top);
  const double often = tests * double(top) / double(descending.size());  // above the base
  return base + mean * std::log(std::max(1.0, often / rate));
}

}  // namespace

double alarm_threshold(std::vector<double> nulls, double tests, double rate) {
  constexpr size_t kTail = 20, kLeastTail = 4;
  const double markov = std::log(std::max(1.0, tests) / rate);
  const size_t top = std::min(kTail, nulls.size() / 4);
  if (top < kLeastTail) return markov;
  std::sort(nulls.begin(), nulls.end(), std::greater<double>());
  // How far ratios lie below 0, where nobody would believe them, says little of how they end above.
  const auto high = size_t(
      std::count_if(nulls.begin(), nulls.begin() + top, [](double nats) { return nats > 0; }));
  const double above =
      high < kLeastTail ? markov : by_tail(nulls, high, std::max(0.0, nulls[high]), tests, rate);
  return std::max(std::log(1 / rate),
                  std::min(above, by_tail(nulls, top, nulls[top], tests, rate)));
}

}  // namespace sketchsplat
