// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "pipelines/candidates/known_curves.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// Planes across one direction in which strokes lie: floors, faces, steps of a part.
struct Levels {
  Eigen::Vector3d normal;                 ///< unit
  std::vector<double> height;             ///< ascending, along the normal, by the longest strokes
  std::vector<std::vector<int>> strokes;  ///< per level: those that lie in it
};

/// Unit normal of the plane of a circle, an ellipse or an arc of one; zero of other curves.
Eigen::Vector3d plane_normal(StrokeKind kind, const ControlPoints& controls);

/// Directions that at least two planar strokes or corners have in common, those of most first, at
/// most twelve, each with its levels. `tolerance`: distance of a stroke from its level, world
/// units.
std::vector<Levels> find_levels(const Sketch& sketch, double tolerance);

/// Of each level, whether it is one of the eight that hold the most strokes. Where everything is a
/// level, as on a natural surface, the others tell nothing, and what is tried in all of them would
/// be as many as strokes squared.
std::vector<char> main_levels(const Levels& levels);

/// The curve moved: along a vector, turned, mirrored.
Candidate moved(const Candidate& candidate, const Eigen::Affine3d& by);
Candidate moved(const Candidate& candidate, const Eigen::Vector3d& by);

/// In the plane across a unit normal, at a height along it.
Eigen::Affine3d mirror(const Eigen::Vector3d& normal, double height);

/// Moves a curve that lies in a level, but for `tolerance`, exactly into it, of every direction:
/// curves are copied from strokes that err, levels are what all of their strokes say together.
void settle(const std::vector<Levels>& levels, double tolerance, Candidate* candidate);

/// What is in one level, in the other ones: the other rim of a hole, the floor of a pocket whose
/// depth others share, the far side of a plate. Copies go to main levels.
std::vector<Candidate> level_copies(const Sketch& sketch, const std::vector<Levels>& levels);

}  // namespace sketchsplat
