// SPDX-License-Identifier: MIT
#pragma once

#include "datasets/types/camera.h"
#include "datasets/types/geometry_maps.h"

namespace sketchsplat {

/// How far the depth and normals of a view are from the true ones.
struct MapErrors {
  double normal_deg = 0;  ///< mean angle of the normals [deg]
  double depth_px = 0;    ///< median of |depth - true depth| [pixel footprints]
  double covered = 0;     ///< share of the object's pixels that have both, [0, 1]
};

/// Over the pixels that the true maps call object; the errors over those that are covered. All 0
/// if none is. Precondition: all maps have the camera's size.
MapErrors score_geometry(const GeometryMaps& maps, const GeometryMaps& truth, const Camera& camera);

}  // namespace sketchsplat
