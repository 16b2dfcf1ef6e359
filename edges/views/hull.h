// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace sketchsplat {
struct EdgeWorld;
}

namespace sketchsplat {

/// The part of space that every mask holds: a voxel grid that contains the object and little more
/// (Laurentini, PAMI 1994). A point whose line of sight meets no voxel on the way is seen for sure.
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

  Eigen::Vector3d low_ = Eigen::Vector3d::Zero();
  double cell_ = 0;
  int nx_ = 0, ny_ = 0, nz_ = 0;
  /// Of a cell: 0 outside a mask, 1 across the edge of one, 2 inside all.
  std::vector<uint8_t> occupied_;
};

}  // namespace sketchsplat
