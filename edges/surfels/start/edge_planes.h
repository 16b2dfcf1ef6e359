// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "edges/surfels/start/sure_edges.h"

namespace sketchsplat {

/// A plane that edges lie in, perhaps that of a face.
using EdgePlane = Eigen::Hyperplane<double, 3>;

/// The planes that faces of the object lie in: RANSAC over pairs of edge points, near ones as often
/// as far ones, then greedily the plane that explains the most points that are not explained yet.
/// An edge is explained by two planes, a print inside a face by one: any two parallel edges share a
/// plane, and without that rule most planes would be no face's. At most 48. `seed`: of the pairs
/// that are drawn. The same for any number of threads.
std::vector<EdgePlane> edge_planes(const SureEdges& edges, int seed = 0);

}  // namespace sketchsplat
