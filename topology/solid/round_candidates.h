// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sketches/graph/sketch.h"
#include "topology/solid/contours.h"
#include "topology/solid/find_surfaces.h"
#include "topology/solid/infer_edges.h"

namespace sketchsplat {

struct RoundCandidates {
  std::vector<SurfaceStrokes> surfaces;  ///< with the strokes that lie on them
  std::vector<ImpliedStroke> rims;       ///< circles where they run smoothly into a cylinder
};

/// Spheres and tori that circles and contours ask for: spheres through two circles about one axis;
/// and where one number is free, that on which contours agree: spheres over a circle, as caps or as
/// the round head of a cylinder; tori between two circles about one axis, and those of bent pipes,
/// between equal circles whose axes meet. Contours of the cylinders and cones that are `known` tell
/// nothing. `polylines` as polylines_of(sketch); `tolerance`: of a stroke from its surface, world
/// units.
RoundCandidates round_candidates(const Sketch& sketch,
                                 const std::vector<Eigen::Matrix3Xd>& polylines,
                                 const std::vector<SurfaceStrokes>& known,
                                 const std::vector<ContourLine>& contours, double tolerance);

}  // namespace sketchsplat
