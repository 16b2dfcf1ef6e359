// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "datasets/readers/scene.h"
#include "datasets/types/image.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// At most `count` views whose directions to `target` (world) are far from one another, in the
/// order of the scene. The first view is always among them. Empty if there are no views or count <=
/// 0.
std::vector<int> spread_views(const std::vector<View>& views, const Eigen::Vector3d& target,
                              int count);

struct PaintedLine {
  Eigen::Matrix3Xd points;     ///< 3 x N in order, world units
  std::array<float, 3> color;  ///< red, green, blue in [0, 1]
  int width = 2;               ///< px of the overlay
};

/// The curves of a sketch in the colours of their kinds.
std::vector<PaintedLine> painted_curves(const Sketch& sketch);

/// Polylines, hidden ones too and the last on top, over a paled picture of the view; at most
/// `longest` px wide and high. An empty picture counts as white. What lies behind the camera is
/// left out.
Picture draw_overlay(const std::vector<PaintedLine>& lines, const View& view,
                     const Picture& picture, int longest = 1200);

/// The same over `count` views that are spread around `target`, as files PREFIX_<view>.png in a
/// folder; older ones of that prefix go. A picture that cannot be read is white, and `warn` is
/// called. Returns the paths. Throws OutputError.
std::vector<std::string> write_overlays(const std::string& folder, const std::string& prefix,
                                        const std::vector<PaintedLine>& lines,
                                        const std::vector<View>& views,
                                        const Eigen::Vector3d& target, int count,
                                        const std::function<void(const std::string&)>& warn,
                                        int longest = 1200);

}  // namespace sketchsplat
