// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

namespace sketchsplat {

/// The part of space that holds the object, among other things.
struct ObjectRegion {
  Eigen::AlignedBox3d box;  ///< around all of it; empty: nobody knows, everything may belong to it
  /// What the object stands on: inside of the half space of positive distances.
  std::optional<Eigen::Hyperplane<double, 3>> table;
  double above = 0;  ///< height over the table, world units, up to which what is seen may be on it
  /// The object seen along the table's normal: corners of convex polygons, counter-clockwise, in
  /// the plane's frame (x, y of `frame`); empty without a table. The one on the table is smaller.
  std::vector<Eigen::Vector2d> outline, outline_on_table;
  Eigen::Matrix<double, 2, 3> frame = Eigen::Matrix<double, 2, 3>::Zero();
  std::vector<Eigen::Vector3d> edges;  ///< points on its edges, of which that is sure

  bool contains(const Eigen::Vector3d& point) const;
};

}  // namespace sketchsplat
