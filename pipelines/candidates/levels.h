// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "pipelines/candidates/candidate.h"

namespace sketchsplat {

/// Sine of the angle of strokes that meet in a corner, at least: others go on smoothly.
inline constexpr double kCornerSine = 0.2;

/// Planes across one direction in which strokes lie: floors, faces, steps of a part.
struct Levels {
  Eigen::Vector3d normal;                 ///< unit
  std::vector<double> height;             ///< ascending, along the normal, by the longest strokes
  std::vector<std::vector<int>> strokes;  ///< per level: those that lie in it
};

/// Directions that at least two planar strokes or corners have in common, those of most first, at
/// most twelve, each with its levels. `tolerance`: distance of a stroke from its level, world
/// units.
std::vector<Levels> find_levels(const Sketch& sketch, double tolerance);

/// Of each level, whether it is one of the eight that hold the most strokes. Where everything is a
/// level, as on a natural surface, the others tell nothing, and what is tried in all of them would
/// be as many as strokes squared.
std::vector<char> main_levels(const Levels& levels);

/// Moves a curve that lies in a level, but for `tolerance`, exactly into it, of every direction:
/// curves are copied from strokes that err, levels are what all of their strokes say together.
void settle(const std::vector<Levels>& levels, double tolerance, Candidate* candidate);

}  // namespace sketchsplat
