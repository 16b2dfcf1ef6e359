// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "sketches/graph/sketch.h"
#include "sketches/graph/solid.h"

namespace sketchsplat {

/// A surface that faces may lie on, and the strokes that do.
struct SurfaceStrokes {
  Surface surface;
  std::vector<int> strokes;  ///< ascending
  bool around_tube = false;  ///< strokes run around the tube of this torus, not around its axis
  /// Does a place belong to the part that something speaks for? Empty: all of it.
  std::function<bool(const Eigen::Vector3d&)> part = {};
  double bonus = 0;  ///< [nat] by which it is likelier than others of its kind
};

/// Strokes that lie on a surface, ascending.
std::vector<int> strokes_on(const Surface& surface, const std::vector<Eigen::Matrix3Xd>& polylines,
                            double tolerance);

/// Surfaces that strokes ask for: planes of strokes that meet; cylinders and cones through an arc
/// or circle, about its axis, and cylinders cut in an ellipse, that hold more than the strokes of
/// one plane. Of surfaces that
/// hold the same strokes there is one. `polylines` as polylines_of(sketch); `tolerance`: distance
/// of a stroke from its surface, world units.
std::vector<SurfaceStrokes> find_surfaces(const Sketch& sketch,
                                          const std::vector<Eigen::Matrix3Xd>& polylines,
                                          double tolerance);

}  // namespace sketchsplat
