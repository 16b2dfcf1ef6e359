// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "edges/views/lift.h"
#include "edges/views/object_region.h"

namespace sketchsplat {

struct RegionOptions {
  int min_views = 4;  ///< that any point has; those beyond them count
  int seed = 0;       ///< of the planes that are tried
  /// Edges of the object that an earlier look has told: what stands among them is part of it.
  std::vector<Eigen::Vector3d> known;
};

/// Finds the object that the cameras look at among points on edges. The table is the plane with the
/// most points over which all cameras and nearly all points are; what stands on it falls apart,
/// seen from above, into groups, of which the object is the one with the most points near `middle`,
/// where the optical axes meet. Only points count that have others along their tangents: an object
/// of nothing but rings of less than some 40 px radius is not found. Without a table, or with
/// nothing on it, the box is that of all points. `footprint`: world length of a pixel; `reach`:
/// radius of what the cameras look at, world units.
ObjectRegion find_object(const std::vector<EdgePoint>& points,
                         const std::vector<Eigen::Vector3d>& cameras, const Eigen::Vector3d& middle,
                         double reach, double footprint, const RegionOptions& options);

/// The region and what lies within a distance `by` of it, world units.
ObjectRegion wider(ObjectRegion region, double by);

/// The region of places that the object takes up, and what lies within a margin, world units, of
/// them. On the same table, where edges told better what of it is the object's.
ObjectRegion region_around(const std::vector<Eigen::Vector3d>& places, double margin,
                           const ObjectRegion& before);

}  // namespace sketchsplat
