// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "eval/solids/surface_errors.h"
#include "sketches/graph/solid.h"

namespace sketchsplat {

enum class SolidDimensionKind {
  kDiameter,       ///< of a cylinder or a sphere that faces run around by half and more
  kRadius,         ///< of other cylinders and spheres
  kRingDiameter,   ///< of a torus: of its circle of centres
  kTubeRadius,     ///< of a torus
  kConeAngle,      ///< between opposite lines of a cone
  kPlaneDistance,  ///< of parallel planes
  kAxisToPlane,    ///< of an axis from a plane parallel to it
  kAxisDistance,   ///< of parallel axes
  kPlaneAngle      ///< between faces on planes that share an edge
};
const char* solid_dimension_name(SolidDimensionKind kind);  ///< "diameter", "plane distance", ...
constexpr bool is_angle(SolidDimensionKind kind) {
  return kind == SolidDimensionKind::kConeAngle || kind == SolidDimensionKind::kPlaneAngle;
}

struct SolidDimension {
  SolidDimensionKind kind = SolidDimensionKind::kDiameter;
  std::vector<int> surfaces;  ///< one or two: indices into Solid::surfaces
  bool opposite = false;      ///< of kPlaneAngle: the axes look to different sides of the faces
  double value = 0;           ///< world units; angles in degrees
  double sigma = 0;           ///< standard deviation, see SurfaceErrors; NaN if nobody knows
};

/// What a drawing would state of a solid: sizes of round surfaces; distances of neighbouring
/// parallel planes and of the outer ones; axes (of cylinders and cones that faces run around by
/// half and more) from the nearer of the two outer planes of each direction that they are parallel
/// to, and from their neighbours (least spanning tree); angles of faces that share an edge, if
/// neither parallel nor square. What lies within the tolerance of curves counts as one plane, or
/// one axis.
std::vector<SolidDimension> find_solid_dimensions(const Solid& solid, const SurfaceErrors& errors);

}  // namespace sketchsplat
