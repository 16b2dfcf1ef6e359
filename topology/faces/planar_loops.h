// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sketches/graph/face.h"
#include "sketches/graph/sketch.h"
#include "topology/faces/find_planes.h"

namespace sketchsplat {

/// Minimal cycles of strokes that lie in one plane, as faces: the graph of the strokes over their
/// nodes is walked with the sharpest left turn at every node, after strokes that are part of no
/// cycle were left out. A cycle inside another one, of other nodes, is a hole in it; one in a hole
/// is a face again (even-odd rule). Left out are faces whose boundary crosses itself and those
/// thinner than `tolerance` (world units).
/// `polylines`: 3 x n points along every stroke of the sketch, from begin to end, both included.
std::vector<PlanarFace> faces_in_plane(const Sketch& sketch,
                                       const std::vector<Eigen::Matrix3Xd>& polylines,
                                       const std::vector<int>& members, const Plane& plane,
                                       double tolerance);

}  // namespace sketchsplat
