// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "datasets/readers/scene.h"
#include "datasets/types/image.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// Colour by which people tell the kinds apart: red, green, blue in [0, 1].
std::array<float, 3> kind_color(StrokeKind kind);

/// At most `count` views whose directions to `target` (world) are far from one another, in the
/// order of the scene. The first view is always among them. Empty if there are no views or count <=
/// 0.
std::vector<int> spread_views(const std::vector<View>& views, const Eigen::Vector3d& target,
                              int count);

/// The curves, hidden ones too, over a paled picture of the view; at most `longest` px wide and
/// high. An empty picture counts as white. What lies behind the camera is left out.
Picture draw_overlay(const Sketch& sketch, const View& view, const Picture& picture,
                     int longest = 1200);

struct PaintedLine {
  Eigen::Matrix3Xd points;     ///< 3 x N in order, world units
  std::array<float, 3> color;  ///< red, green, blue in [0, 1]
  int width = 2;               ///< px of the overlay
};

/// The same of any polylines, the last on top.
Picture draw_overlay(const std::vector<PaintedLine>& lines, const View& view,
                     const Picture& picture, int longest = 1200);

}  // namespace sketchsplat
