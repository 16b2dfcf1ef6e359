// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "edges/tags/tag_square.h"

namespace sketchsplat {

/// A place on a tag where black borders white; in sides of the black square from its middle, to the
/// right and down.
struct TagEdge {
  Eigen::Vector2d place;
  Eigen::Vector2d along;  ///< unit, along the border
  Eigen::Vector2d white;  ///< unit, across it, from black to white
};

/// Three places on each side of a cell that borders one of the other colour.
std::vector<TagEdge> tag_edges(int id);

/// How far from a pixel of the image, along a unit normal from dark to bright, the edge is, looked
/// for within `half_width` [px]: the middle of the rise, under light that may grow or fall off
/// across it. False if the picture does not hold one there that rises by at least `least_rise` in
/// linear light.
bool edge_offset(const TagPatch& patch, const Eigen::Vector2d& pixel, const Eigen::Vector2d& normal,
                 double half_width, double least_rise, double* offset);

}  // namespace sketchsplat
