// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

namespace sketchsplat {

/// Corners of the convex polygon around all places, counter-clockwise.
std::vector<Eigen::Vector2d> convex_hull(const std::vector<Eigen::Vector2d>& places);

/// Corners of squares around all places: the hull of them is wider by the margin.
std::vector<Eigen::Vector2d> widened(const std::vector<Eigen::Vector2d>& places, double margin);

/// Does a convex polygon, counter-clockwise, hold a place? An empty one holds none.
bool is_inside(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& place);

}  // namespace sketchsplat
