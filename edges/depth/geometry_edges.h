// SPDX-License-Identifier: MIT
#pragma once

#include "datasets/types/camera.h"
#include "datasets/types/geometry_maps.h"
#include "edges/image/detect.h"

namespace sketchsplat {

struct GeometryOptions {
  double sigma_px = 1.0;     ///< [px] smoothing of the gradients that propose edges
  double jump_px = 3.0;      ///< [pixel footprints] depth jump that is an edge
  double crease_deg = 12.0;  ///< [deg] turn of the normal that is an edge
  double shallow_deg = 6.0;  ///< [deg] the same where sides are even over twice the width; 0: none
  double noise = 4.0;        ///< all also exceed this many standard deviations of their noise
  bool rims = false;         ///< keep the contours of round surfaces, which are no edges
  int min_chain = 6;         ///< [px] shorter chains are dropped
};

/// What is measured in the smooth parts of a view's maps; thresholds follow it.
struct GeometryNoise {
  double jump_px = 0;     ///< of the step between planes fitted to two sides [pixel footprints]
  double crease_deg = 0;  ///< of the turn between normals of two sides, each component [deg]
};

/// Edgels of a view's geometry: where alpha ends (outline), where depth steps between the planes
/// of both sides (occlusion), and where the normal turns within about three pixels (crease; the
/// steady turn of a round surface is none). A step or turn is localised by the least-squares step
/// across it (of alpha, of depth between the two planes, of the normal), a crease also by the line
/// where the planes of its sides meet, weighed by their errors. Normals of edgels point to the
/// nearer side; across creases their sign means nothing. `strength` is a confidence in [0, 1]: J^2
/// / (J^2 + t^2) of the jump J and its threshold t. Depth of a map without an object <= 0 or
/// not finite. Empty maps give an empty result. `noise`, if given, tells what was measured.
EdgelMap geometry_edges(const GeometryMaps& maps, const Camera& camera,
                        const GeometryOptions& options, GeometryNoise* noise = nullptr);

}  // namespace sketchsplat
