// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "edges/surfels/start/sure_edges.h"

namespace sketchsplat {

/// A plane that edges lie in, perhaps that of a face.
using EdgePlane = Eigen::Hyperplane<double, 3>;

struct EdgePlaneOptions {
  double reach_px = 1;         ///< [pixel footprints] from a point to its plane
  double angle_deg = 6;        ///< [deg] between a tangent and the plane
  double part_deg = 25;        ///< [deg] least turn between the two planes of an edge
  double least_new = 0.5;      ///< share of a plane's points that no other planes explain
  int fewest = 12;             ///< points that make a plane; and
  double least_share = 0.006;  ///< of all points
  int tries = 6000;            ///< pairs of points that are drawn
  int most = 48;               ///< planes, at most 64
  int seed = 0;                ///< of what is drawn
};

/// The planes that faces of the object lie in: RANSAC over pairs of edge points, near ones as often
/// as far ones, then greedily the plane that explains the most points that are not explained yet.
/// An edge is explained by two planes, a print inside a face by one: any two parallel edges share a
/// plane, and without that rule most planes would be no face's. The same for any number of threads.
std::vector<EdgePlane> edge_planes(const SureEdges& edges, const EdgePlaneOptions& options = {});

}  // namespace sketchsplat
