// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace sketchsplat {
struct EdgeWorld;
}

namespace sketchsplat {

/// Cells of a box in space.
struct VoxelGrid {
  Eigen::Vector3d low = Eigen::Vector3d::Zero();
  double cell = 0;  ///< side length, world units
  Eigen::Vector3i count = Eigen::Vector3i::Zero();

  size_t size() const { return size_t(count.x()) * count.y() * count.z(); }
  /// Index of the cell that holds a point; false outside.
  bool find(const Eigen::Vector3d& p, size_t* index) const;
};

/// The part of space that every mask holds: a voxel grid that contains the object and little more
/// (Laurentini, PAMI 1994). Where things before the object cut masks of it, the part that all but a
/// few hold: as few as make it show in all that the masks hold. A point whose line of sight meets
/// no voxel on the way is seen for sure.
class VisualHull {
 public:
  VisualHull() = default;  ///< empty: nothing is sure
  /// `cells` along the longest side of the world's bounds. Where there is no mask, the silhouette
  /// counts. Without either the hull is empty and nothing is sure.
  VisualHull(const EdgeWorld& world, int cells);

  bool empty() const { return occupied_.empty(); }
  /// Does nothing of the hull stand between the point and the camera, but for the hull's surface
  /// in the point's own surroundings (two and a half cells)? False if the hull is empty.
  bool surely_visible(const Eigen::Vector3d& point, const Eigen::Vector3d& camera) const;
  /// Narrows an interval of s to where origin + s * direction (unit) lies in the hull or `around`
  /// cells before or behind it; what lies between two parts of it stays. False if it meets none of
  /// it. An empty hull narrows nothing.
  bool clip(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double around,
            double* s0, double* s1) const;

 private:
  uint8_t at(const Eigen::Vector3d& p) const;

  VoxelGrid grid_;
  /// Of a cell: 0 outside a mask, 1 across the edge of one, 2 inside all.
  std::vector<uint8_t> occupied_;
};

}  // namespace sketchsplat
