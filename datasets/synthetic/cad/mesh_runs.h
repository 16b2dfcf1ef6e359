// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// A piece of a run of mesh edges and the curve that it stands for.
struct MeshCurve {
  StrokeKind kind = StrokeKind::kLine;
  int first = 0, last = 0;               ///< columns of the run; closed kinds span the whole of it
  std::vector<Eigen::Vector3d> handles;  ///< as many as the kind has
};

/// Cuts a run of points without corners (3 x N, N >= 2) into lines, arcs and cubics that end on its
/// points; a run that closes (last point = first) may be one circle or ellipse. Every point lies
/// within `tolerance` of its curve.
std::vector<MeshCurve> cut_run(const Eigen::Matrix3Xd& points, double tolerance);

}  // namespace sketchsplat
