// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sketches/graph/face.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

struct PlanarFaceOptions {
  double tolerance = 1e-3;  ///< distance of a stroke from its plane; fraction of the extent
};

/// Faces that closed planar loops of strokes bound (see faces_in_plane). Planes grow from strokes
/// that meet, and from single bent strokes, over neighbours, as long as one least-squares plane
/// keeps all within the tolerance; loops that do not touch join the plane that they lie in.
/// Of two faces that share a stroke each runs it in its own direction, as far as that is possible;
/// a connected set of faces turns its normals away from its middle.
/// Geometry alone cannot tell an opening from a face: a loop around nothing becomes a face, too,
/// and a loop alone inside a face always is a hole in it.
std::vector<PlanarFace> planar_faces(const Sketch& sketch, const PlanarFaceOptions& options = {});

}  // namespace sketchsplat
