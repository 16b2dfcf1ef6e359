// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// A curve of least squares through an ordered run of points, as add_stroke wants it.
struct RunFit {
  StrokeKind kind = StrokeKind::kLine;
  Eigen::Vector3d begin = Eigen::Vector3d::Zero(), end = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> handles;
  Eigen::VectorXd distance;  ///< of every point from the curve; empty if there is no such curve
  bool ok() const { return distance.size() > 0; }
};

// `points`: 3 x n, in order along the curve. Fast rather than exact: cutting a run asks for
// hundreds.

RunFit line_through(const Eigen::Matrix3Xd& points);

/// Arc, or circle if the run is closed or leaves a gap of at most `closing` (world units) or 0.2
/// rad. Plane from positions and `tangents` (3 x n, unit, sign arbitrary): a short arc bends too
/// little for positions alone.
RunFit arc_through(const Eigen::Matrix3Xd& points, const Eigen::Matrix3Xd& tangents, bool closed,
                   double closing);

/// At least 6 points.
RunFit cubic_through(const Eigen::Matrix3Xd& points);

/// Elliptic arc, or ellipse if the run leaves a gap of at most `closing` (world units) or 0.2 rad.
/// At least 10 points that turn by 0.8 to 5.2 rad or all around (see ellipse_along).
RunFit elliptic_arc_through(const Eigen::Matrix3Xd& points, double closing);

/// Closed; at least 8 points that go around its centre once.
RunFit ellipse_through(const Eigen::Matrix3Xd& points);

}  // namespace sketchsplat
