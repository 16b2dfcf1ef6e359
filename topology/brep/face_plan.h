// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "topology/brep/chart.h"
#include "topology/brep/edge_table.h"

namespace sketchsplat::brep {

/// Where a seam ends: a parameter of a stroke of a loop, or a pole.
struct SeamEnd {
  int loop = -1;  ///< -1: a pole
  int stroke = -1;
  double parameter = 0;
};

/// How a face closes in the chart of its surface.
struct FacePlan {
  explicit FacePlan(const Chart& c) : chart(c) {}

  Chart chart;
  std::vector<Loop> loops;  ///< what belongs to the face lies to the left, as the normal sees it
  bool reversed = false;    ///< out of the material is against the normal
  int outer = -1;           ///< index into loops; -1: a seam makes the outer wire, or there is none
  /// A line of constant u (v, if winds_in_v) from a loop that goes around the surface, or a pole,
  /// to another.
  bool seam = false;
  bool winds_in_v = false;  ///< the loops go around in v, and the seam runs along u
  double at = 0;            ///< u of the seam; v if winds_in_v
  SeamEnd lower, upper;     ///< left of `upper`, and left of `lower`, is the face
};

/// Turned by a quarter where loops go around in v, so that they always go around in the first of
/// two coordinates and the face lies above, in the second, of the loop that runs along it.
Eigen::Vector2d upright(const FacePlan& plan, const Eigen::Vector2d& uv);

/// Decides where the seams are, and cuts the strokes that they end in. Throws Refused if loops run
/// the wrong way round, or do not bound a connected face.
FacePlan plan_face(const Solid& solid, const SolidFace& face, EdgeTable* edges);

}  // namespace sketchsplat::brep
