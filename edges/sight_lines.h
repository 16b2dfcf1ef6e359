// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "edges/lift.h"

namespace sketchsplat {

/// A line of sight that nothing blocks: from a camera to an edge that its picture shows.
struct SightLine {
  Eigen::Vector3d eye, point;  ///< world units
};

struct SightOptions {
  double reach_px = 0.7;   ///< [px] between a point and the edgel that shows it
  double angle_deg = 8;    ///< [deg] between the edgel's plane and the tangent
  double beside_deg = 40;  ///< [deg] between the directions to the camera and to the one in whose
                           ///< picture the point was found: seen from afar it may be hidden, and
                           ///< dense print has an edgel for everything
};

/// The lines from points of edges to the cameras whose edgels show them. Of a printed surface there
/// are many, for print has edges too. A few are wrong, where an edgel is taken for another.
std::vector<SightLine> sight_lines(const EdgeWorld& world, const std::vector<EdgePoint>& points,
                                   const SightOptions& options = {});

}  // namespace sketchsplat
