// SPDX-License-Identifier: MIT
#include "sketches/graph/solid.h"

namespace sketchsplat {

using Eigen::Vector3d;

const char* surface_name(SurfaceKind kind) {
  constexpr const char* kNames[kNumSurfaceKinds] = {"plane",  "cylinder", "cone",
                                                    "sphere", "torus",    "extrusion"};
  return kNames[int(kind)];
}

Solid scaled(Solid solid, double factor) {
  solid.edges.nodes *= factor;
  solid.edges.handles *= factor;
  for (Surface& surface : solid.surfaces) {
    surface.origin *= factor;
    surface.radius *= factor;
    surface.minor_radius *= factor;
    for (Vector3d& p : surface.profile) p *= factor;
  }
  solid.gap *= factor;
  return solid;
}

}  // namespace sketchsplat
