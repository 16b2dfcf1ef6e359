// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "topology/faces/stroke_graph.h"

namespace sketchsplat {

/// A piece of a surface between cycles, all of which keep it on their left.
struct SurfacePiece {
  /// What runs around it or, of a band around the surface, below it; then what bounds the band
  /// above, and holes. Indices.
  std::vector<int> cycles;
  /// Theirs, side by side on surfaces that close; one more at a pole that it ends in.
  std::vector<Eigen::Matrix2Xd> polygons;
};

/// The bounded pieces between simple cycles. `period`: of the coordinates, 0 of one that does not
/// close. `pole`: second coordinate where all first ones are one point, above (1) or below (-1);
/// NaN: there is none. A piece up to there counts as bounded.
std::vector<SurfacePiece> pieces_of(const std::vector<Cycle>& cycles, const Eigen::Vector2d& period,
                                    const std::function<double(int)>& pole);

}  // namespace sketchsplat
