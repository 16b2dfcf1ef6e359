// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// The colour of a kind in all files, pages and overlays: red, green, blue in [0, 1].
inline std::array<float, 3> kind_color(StrokeKind kind) {
  constexpr std::array<float, 3> kColors[kNumKinds] = {
      {0.15f, 0.39f, 0.92f},   // line: blue
      {0.92f, 0.35f, 0.05f},   // arc: orange
      {0.86f, 0.15f, 0.15f},   // circle: red
      {0.58f, 0.20f, 0.92f},   // ellipse: violet
      {0.09f, 0.64f, 0.29f},   // spline: green
      {0.86f, 0.15f, 0.60f}};  // elliptic arc: rose
  return kColors[int(kind)];
}

}  // namespace sketchsplat
