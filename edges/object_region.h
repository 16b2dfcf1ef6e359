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
  /// The object seen along the table's normal: corners of a convex polygon, counter-clockwise, in
  /// the plane's frame (x, y of `frame`); empty without a table.
  std::vector<Eigen::Vector2d> outline;
  Eigen::Matrix<double, 2, 3> frame = Eigen::Matrix<double, 2, 3>::Zero();

  bool contains(const Eigen::Vector3d& point) const;
};

struct RegionOptions {
  double table_px = 2;    ///< [px] of points on the table
  double above_px = 6;    ///< [px] over the table, from where on a point is no print on it
  double gap_px = 24;     ///< [px] seen from above, that parts the object from other things
  double margin_px = 4;   ///< [px] around the object's points
  double least_share = 0.1;  ///< of the points that lie on a plane for it to be a table
};

/// Finds the object that the cameras look at among points on edges: the table is the plane with the
/// most points over which all cameras and nearly all points are; what stands on it falls apart,
/// seen from above, into groups, of which the object is the one with the most points near `middle`,
/// where the optical axes meet. Without a table, or with nothing on it, the box is that of the
/// points. `footprint`: world length of a pixel; `reach`: radius of what the cameras look at, world
/// units.
ObjectRegion find_object(const std::vector<Eigen::Vector3d>& points,
                         const std::vector<Eigen::Vector3d>& cameras, const Eigen::Vector3d& middle,
                         double reach, double footprint, const RegionOptions& options);

}  // namespace sketchsplat
