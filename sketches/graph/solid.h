// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "sketches/graph/face.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

enum class SurfaceKind { kPlane, kCylinder, kCone, kSphere, kTorus, kExtrusion };
constexpr int kNumSurfaceKinds = 6;
const char* surface_name(SurfaceKind kind);  ///< "plane", "cylinder", ...

// clang-format off
/// An unbounded surface of revolution, a plane, or what a curve sweeps. World units.
///   plane     origin: any point of it      axis: unit normal
///   cylinder  origin: any point of its axis                       radius
///   cone      origin: a point of its axis, where it has `radius`; slope: change of the radius per
///             unit of length along the axis, not 0
///   sphere    origin: centre               axis: any               radius
///   torus     origin: centre               axis                    radius: of the centres' circle
///             minor_radius: of the tube
///   extrusion origin: of no account    axis: along which the profile is moved, never tangent to it
///             profile: a plane curve; its normal is along the profile's direction x axis
// clang-format on
struct Surface {
  SurfaceKind kind = SurfaceKind::kPlane;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  double radius = 0;
  double slope = 0;
  double minor_radius = 0;
  StrokeKind profile_kind = StrokeKind::kLine;
  std::vector<Eigen::Vector3d> profile = {};  ///< control points, see StrokeKind
};

/// A bounded part of a surface. Seen from outside the solid its loops run counter-clockwise about
/// what belongs to it, holes clockwise; which loop is the outer one of a face that runs around a
/// cylinder has no meaning. A whole sphere or torus has no loops.
struct SolidFace {
  int surface = -1;         ///< index into Solid::surfaces
  bool reversed = false;    ///< out of the material is against the surface's normal: away from the
                            ///< axis, the centre or a torus' circle of centres, of a plane its
                            ///< axis, of an extrusion its profile's direction x axis
  std::vector<Loop> loops;  ///< over the strokes of Solid::edges
};

/// A closed volume: every stroke of `edges` is run once in either direction by the loops of
/// `faces`, in all. Curves lie on their surfaces up to `Solid::gap`.
struct Solid {
  Sketch edges;
  std::vector<bool> inferred;  ///< per stroke: no image shows it, the faces imply it
  std::vector<Surface> surfaces;
  std::vector<SolidFace> faces;
  /// Largest distance of a curve from the surfaces that it bounds, world units. Of a curve whose
  /// kind cannot lie on them (a cubic where round surfaces meet) only the ends count: it stands for
  /// their intersection.
  double gap = 0;
};

/// Signed distance [world units] of a point from a surface: positive on the side of its normal,
/// which points away from the axis, the centre or the circle of centres; of a plane along its axis.
/// Beyond the apex of a cone the radius is counted on. Parameters are scalars, for solvers that ask
/// for derivatives. Not of extrusions: see topology/solid/surface.h.
template <typename T>
T surface_distance(SurfaceKind kind, const Eigen::Matrix<T, 3, 1>& origin,
                   const Eigen::Matrix<T, 3, 1>& axis, const T& radius, const T& slope,
                   const T& minor_radius, const Eigen::Matrix<T, 3, 1>& point) {
  using std::abs;
  using std::sqrt;
  const Eigen::Matrix<T, 3, 1> from = point - origin;
  const T along = from.dot(axis);
  if (kind == SurfaceKind::kPlane) return along;
  const T least(1e-300);  // under roots, which have no derivative at 0
  if (kind == SurfaceKind::kSphere) return sqrt(from.squaredNorm() + least) - radius;
  const T out = sqrt((from - axis * along).squaredNorm() + least);
  if (kind == SurfaceKind::kCylinder) return out - radius;
  if (kind == SurfaceKind::kCone)
    return (out - abs(radius + slope * along)) / sqrt(T(1) + slope * slope);
  const T ring = out - radius;
  return sqrt(ring * ring + along * along + least) - minor_radius;
}

/// The same solid, larger by a factor > 0 about the origin.
Solid scaled(Solid solid, double factor);

}  // namespace sketchsplat
