// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

namespace sketchsplat {

/// The value in the middle, the upper of two; 0 of none.
template <class Number>
Number median(std::vector<Number> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + values.size() / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The value that this share of all values lie below; `values`: one or more.
template <class Number>
Number quantile(std::vector<Number> values, double share) {
  const size_t at = std::min(values.size() - 1, size_t(share * double(values.size())));
  std::nth_element(values.begin(), values.begin() + long(at), values.end());
  return values[at];
}

/// Standard deviation of normal numbers of mean 0, from their absolute values: outliers do not
/// matter (Hampel: The influence curve and its role in robust estimation, JASA 1974). 0 of none.
template <class Number>
double normal_sigma(std::vector<Number> absolute) {
  return 1.4826 * median(std::move(absolute));
}

}  // namespace sketchsplat
