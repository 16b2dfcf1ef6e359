// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace sketchsplat {

/// Units of length that CAD programs know, in the order of length_unit_names().
enum class LengthUnit { kMillimetre, kCentimetre, kMetre, kInch };

inline std::vector<std::string> length_unit_names() { return {"mm", "cm", "m", "inch"}; }

inline double millimetres(LengthUnit unit) {
  constexpr double kMillimetres[] = {1, 10, 1000, 25.4};
  return kMillimetres[int(unit)];
}

}  // namespace sketchsplat
