// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "eval/metrics/structure.h"

namespace sketchsplat {

constexpr double kMeeting = 2e-3;  ///< ends this close meet, fraction of the longest side

/// Ends of curves that meet: each within kMeeting of another one of them.
struct MeetingPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< their mean
  std::vector<int> curves;                             ///< one entry per end
};

/// First and last points of all curves (3 x N each, N >= 1), gathered where they meet; an end that
/// meets none stands alone. In the order of their first ends.
std::vector<MeetingPoint> meeting_points(const std::vector<Eigen::Matrix3Xd>& curves);

/// Junctions: points where ends of at least two curves meet. So neither a closed curve by itself
/// nor an end on the middle of another curve makes one. Where two curves of one type continue each
/// other smoothly and nothing else ends there is none either (see merge_smooth()): the caller joins
/// them, in prediction and truth alike. Junctions of different types that continue smoothly, a line
/// into an arc, are vertices of the CAD model and count.
Junctions match_junctions(const std::vector<TrueEdge>& prediction,
                          const std::vector<TrueEdge>& truth);

}  // namespace sketchsplat
