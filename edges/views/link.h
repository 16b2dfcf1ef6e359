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

struct LinkOptions {
  double merge_px = 2.0;   ///< [px] points of one curve nearer than this along it become one
  double aside_px = 1.0;   ///< [px] largest offset across the tangent of points of one curve
  double reach_px = 14.0;  ///< [px] longest step from point to point
  double bend_deg = 20.0;  ///< [deg] largest disagreement with the circle through both points
};

/// One point per place: the best supported point absorbs its neighbours along the tangent.
std::vector<EdgePoint> thin_points(const std::vector<EdgePoint>& points, double footprint,
                                   const LinkOptions& options);

/// Joins points that continue one another: each points at its best successor on either side, mutual
/// choices are links. Lone points are left out. Deterministic; independent of the signs of
/// tangents.
std::vector<PointChain> link_points(const std::vector<EdgePoint>& points, double footprint,
                                    const LinkOptions& options);

}  // namespace sketchsplat
