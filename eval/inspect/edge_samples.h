// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// Points along strokes; those of a stroke are consecutive, in its direction.
struct EdgeSamples {
  Eigen::Matrix3Xd position;   ///< 3 x N
  Eigen::Matrix3Xd tangent;    ///< 3 x N, unit
  std::vector<int> stroke;     ///< N
  std::vector<double> t;       ///< N  curve parameter
  std::vector<double> length;  ///< N  arc length that the sample stands for
  std::vector<int> first;      ///< S + 1  of stroke s: first[s] .. first[s + 1] - 1
  int size() const { return int(stroke.size()); }
};

/// Uniform in arc length, both ends of open strokes included, at most `spacing` apart and at least
/// `least` a stroke.
EdgeSamples sample_edges(const Sketch& sketch, double spacing, int least);

/// Finds samples near a place that run along a direction.
class SampleGrid {
 public:
  /// `samples` must live as long; queries reach up to `reach`, > 0.
  SampleGrid(const EdgeSamples& samples, double reach);

  /// Index of the nearest sample within `reach` (at most the grid's) of `point` whose tangent, or
  /// its opposite, turns from `tangent` by no more than an angle of this cosine; -1 if none.
  int nearest(const Eigen::Vector3d& point, const Eigen::Vector3d& tangent, double reach,
              double least_cosine) const;

 private:
  const EdgeSamples& samples_;
  Eigen::Vector3d low_ = Eigen::Vector3d::Zero();
  double cell_ = 1;
  Eigen::Array3i size_ = Eigen::Array3i::Zero();
  std::vector<int> first_;  // of each cell and one more, into order_
  std::vector<int> order_;
};

}  // namespace sketchsplat
