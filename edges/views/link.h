// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "edges/views/lift.h"

namespace sketchsplat {

/// Points in the order in which one follows a curve.
struct PointChain {
  std::vector<int> points;  ///< indices
  bool closed = false;      ///< the last point is followed by the first
};

/// One point per place: the best supported point absorbs its neighbours along the tangent.
std::vector<EdgePoint> thin_points(const std::vector<EdgePoint>& points, double footprint);

/// Joins points that continue one another: each points at its best successor on either side, mutual
/// choices are links. Lone points are left out. Deterministic; independent of the signs of
/// tangents.
std::vector<PointChain> link_points(const std::vector<EdgePoint>& points, double footprint);

}  // namespace sketchsplat
