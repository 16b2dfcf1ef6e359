// SPDX-License-Identifier: MIT
#include "edges/contrast/alarm_threshold.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace sketchsplat {

double alarm_threshold(std::vector<double> nulls, double tests, double rate) {
  constexpr size_t kTail = 20, kLeastTail = 4;
  const size_t top = std::min(kTail, nulls.size() / 4);
  if (top < kLeastTail) return std::log(std::max(1.0, tests) / rate);
  std::nth_element(nulls.begin(), nulls.begin() + top, nulls.end(), std::greater<double>());
  double mean = 0;
  for (size_t k = 0; k < top; ++k) mean += (nulls[k] - nulls[top]) / double(top);
  const double often = tests * double(top) / double(nulls.size());  // above nulls[top]
  const double threshold = nulls[top] + mean * std::log(std::max(1.0, often / rate));
  return std::max(std::log(1 / rate), threshold);
}

}  // namespace sketchsplat
