// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
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

}  // namespace sketchsplat
