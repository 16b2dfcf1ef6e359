// SPDX-License-Identifier: MIT
#include "sketches/graph/solid.h"

namespace sketchsplat {

using Eigen::Vector3d;

const char* surface_name(SurfaceKind kind) {
  constexpr const char* kNames[kNumSurfaceKinds] = {"plane", "cylinder", "cone", "sphere", "torus"};
  return kNames[int(kind)];
}

double surface_distance(const Surface& s, const Vector3d& point) {
  return surface_distance<double>(s.kind, s.origin, s.axis, s.radius, s.slope, s.minor_radius,
                                  point);
}

Solid scaled(Solid solid, double factor) {
  solid.edges.nodes *= factor;
  solid.edges.handles *= factor;
  for (Surface& surface : solid.surfaces) {
    surface.origin *= factor;
    surface.radius *= factor;
    surface.minor_radius *= factor;
  }
  solid.gap *= factor;
  return solid;
}

}  // namespace sketchsplat
