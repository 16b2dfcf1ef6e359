// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>

#include "topology/solid/circle_rim.h"
#include "topology/solid/contours.h"

namespace sketchsplat {

/// Spheres through a rim, of which the cap on the side of its axis: parameter [rad] is how far the
/// centre rises over the rim, seen from it: from -pi / 2, flat, over 0, a half, to pi / 2.
RoundFamily caps(const CircleRim& rim);

/// Cones over a rim, on the side of its axis: parameter [rad] is the angle by which they rise.
RoundFamily tips(const CircleRim& rim);

/// The round head of a cylinder that rises from a rim: parameter [world units] is the height of the
/// centre.
RoundFamily heads(const CircleRim& rim);

/// Tori through two rims about one axis: parameter [rad] is half the turn of the arc between them,
/// positive if it bends away from the axis, or, where both lie in one plane, along the axis of the
/// first. None that run through themselves.
RoundFamily rings(const CircleRim& a, const CircleRim& b);

/// Pipes between two equal rims whose axes meet.
struct Bend {
  Eigen::Vector3d corner;  ///< where the axes meet
  Eigen::Vector3d to_a, to_b;
  double length_a = 0, length_b = 0;  ///< from the corner to the rims
  double half = 0;                    ///< half the angle between to_a and to_b
  double radius = 0;                  ///< of the pipe
  /// From the corner to where a bend of this radius begins.
  double tangent(double bend) const { return bend / std::tan(half); }
  double largest() const { return std::min(length_a, length_b) * std::tan(half); }
};
std::optional<Bend> bend_of(const CircleRim& a, const CircleRim& b, double tolerance);
/// Its tori: parameter [world units] is the radius of the bend.
RoundFamily bends(const Bend& bend);

}  // namespace sketchsplat
