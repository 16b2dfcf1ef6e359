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
  /// The object seen along the table's normal: corners of convex polygons, counter-clockwise, in the
  /// plane's frame (x, y of `frame`); empty without a table. The one on the table is smaller.
  std::vector<Eigen::Vector2d> outline, outline_on_table;
  Eigen::Matrix<double, 2, 3> frame = Eigen::Matrix<double, 2, 3>::Zero();

  bool contains(const Eigen::Vector3d& point) const;
};

struct EdgePoint;

struct RegionOptions {
  int min_views = 4;      ///< that any point has; those beyond them count
  double line_px = 30;    ///< [px] along its tangent, within which others bear a point out
  double line_views = 6;  ///< views beyond min_views that these and the point have together
  double table_px = 2;    ///< [px] of points on the table
  double above_px = 6;    ///< [px] over the table, from where on a point is no print on it
  double gap_px = 24;     ///< [px] seen from above, that parts the object from other things
  double margin_px = 4;   ///< [px] around the object's points, on the table
  double reach_px = 20;   ///< [px] the same above it, where nothing else is near
  double least_share = 0.1;  ///< of the points that lie on a plane for it to be a table
};

/// Finds the object that the cameras look at among points on edges, of which only those count that
/// have others along their tangents. The table is the plane with the most points over which all
/// cameras and nearly all points are; what stands on it falls apart, seen from above, into groups, of
/// which the object is the one with the most points near `middle`, where the optical axes meet. Without a table, or with nothing on it, the box is that of the points.
/// `footprint`: world length of a pixel; `reach`: radius of what the cameras look at, world units.
ObjectRegion find_object(const std::vector<EdgePoint>& points,
                         const std::vector<Eigen::Vector3d>& cameras, const Eigen::Vector3d& middle,
                         double reach, double footprint, const RegionOptions& options);

}  // namespace sketchsplat
