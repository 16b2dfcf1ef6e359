// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "datasets/types/camera.h"
#include "datasets/types/geometry_maps.h"
#include "edges/depth/geometry_edges.h"
#include "edges/image/detect.h"

namespace sketchsplat {

/// An edgel of a picture, and where in space it is thought to lie.
struct EdgelPlace {
  int edgel = 0;     ///< index in the map
  double depth = 0;  ///< z in the camera, world units
};

/// What the geometry of a view says about one.
struct EdgelSupport {
  /// How surely the shape has an edge there, in [0, 1]: J^2 / (J^2 + t^2) of what the two sides
  /// differ by and its threshold t, as in geometry_edges(): 1/2 at the threshold. 1 on an outline.
  /// -1: a side is too narrow to tell.
  float edge = -1;
  float off_px = 0;  ///< [pixel footprints] from the place to the nearer one of both sides; 0 on an
                     ///< outline: the mask tells
};

/// The part of a view's maps that holds the object: what is kept to be asked again.
struct ObjectMaps {
  GeometryMaps maps;
  Camera camera;       ///< of that part
  int x0 = 0, y0 = 0;  ///< [px] of its first pixel in the view
};
ObjectMaps object_maps(const GeometryMaps& maps, const Camera& camera);

/// Compares the sides of edgels of the picture, no matter whether geometry_edges() has an edge
/// there; `options.noise` is not looked at, for who asks averages. Precondition: maps and edgels
/// are of one view.
std::vector<EdgelSupport> edgel_support(const ObjectMaps& object, const EdgelMap& edgels,
                                        const std::vector<EdgelPlace>& places,
                                        const GeometryOptions& options);

}  // namespace sketchsplat
