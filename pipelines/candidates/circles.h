// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "pipelines/candidates/known_curves.h"

namespace sketchsplat {

/// Cosine of the angle of axes that are parallel.
inline constexpr double kParallel = 0.999;

struct Circle {
  Eigen::Vector3d centre, axis;  ///< axis: unit
  double radius = 0;             ///< world units
};

/// The full circles of a sketch.
std::vector<Circle> circles_of(const Sketch& sketch);

/// The circles without those whose axis is the line, within `tolerance`, of one before.
std::vector<Circle> distinct_axes(const std::vector<Circle>& circles, double tolerance);

Candidate candidate_of(const Circle& circle);

}  // namespace sketchsplat
