// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <iterator>

namespace sketchsplat {

/// Colours that can be told apart, over and over.
inline const char* series_color(size_t index) {
  constexpr const char* kColors[] = {"#2563eb", "#ea580c", "#16a34a", "#9333ea",
                                     "#dc2626", "#0891b2", "#ca8a04", "#db2777",
                                     "#4b5563", "#65a30d", "#7c2d12"};
  return kColors[index % std::size(kColors)];
}

}  // namespace sketchsplat
