// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace sketchsplat {

/// How well edge points of one image lie on its true edges.
struct EdgeMapScore {
  double precision = 0;  ///< share of the points within the tolerance of a true edge, [0, 1]
  double recall = 0;  ///< share of the true edges' length within the tolerance of a point, [0, 1]
  double f = 0;       ///< harmonic mean; 0 if either is 0
  double rms_px = 0;  ///< of the distances of the points within the tolerance [px]
};

/// `points`: 2 x N [px]; `truth`: polylines, 2 x M each, M >= 2. Both in pixels with the centre of
/// the first at (0, 0). Without points precision is 0, without truth recall is 0; without both all
/// is 1.
EdgeMapScore score_edge_points(const Eigen::Matrix2Xd& points,
                               const std::vector<Eigen::Matrix2Xd>& truth, double tolerance_px);

/// Reads {"polylines": [[[x, y], ...], ...]}. Throws InputError.
std::vector<Eigen::Matrix2Xd> read_edge_polylines(const std::string& path);

}  // namespace sketchsplat
