// SPDX-License-Identifier: MIT
#include "sketches/graph/solid.h"

#include <Eigen/Geometry>
#include <cmath>

namespace sketchsplat {

using Eigen::Vector3d;

const char* surface_name(SurfaceKind kind) {
  constexpr const char* kNames[kNumSurfaceKinds] = {"plane", "cylinder", "cone", "sphere", "torus"};
  return kNames[int(kind)];
}

double surface_distance(const Surface& surface, const Vector3d& point) {
  const Vector3d x = point - surface.origin;
  const double along = x.dot(surface.axis);
  const double away = (x - along * surface.axis).norm();
  switch (surface.kind) {
    case SurfaceKind::kPlane:
      return along;
    case SurfaceKind::kCylinder:
      return away - surface.radius;
    case SurfaceKind::kCone:
      // Beyond the apex the radius is counted on.
      return (away - std::abs(surface.radius + surface.slope * along)) /
             std::hypot(1.0, surface.slope);
    case SurfaceKind::kSphere:
      return x.norm() - surface.radius;
    case SurfaceKind::kTorus:
      return std::hypot(away - surface.radius, along) - surface.minor_radius;
  }
  return 0;
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
