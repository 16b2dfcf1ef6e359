// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace sketchsplat {

inline constexpr double kDegree = M_PI / 180;  ///< [rad]

}  // namespace sketchsplat
