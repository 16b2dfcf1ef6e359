// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "datasets/synthetic/cad/brep.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// A sharp edge of the B-rep, sampled on the curve itself (not on the stroke that stands for it).
struct TruthCurve {
  std::string type;  ///< "Line", "Circle" (arcs too), "Ellipse", "BSpline": ABC's names
  bool closed = false;
  Eigen::Matrix3Xd points;  ///< 3 x N, N >= 2; chords within 1e-5 of the extent, at most 0.005 long
  Eigen::Matrix3Xd outward;  ///< 3 x N  unit, into the free space between its faces; zero if none
  double dihedral_deg = 0;   ///< mean angle between the normals of its faces; 180 at a free border
  std::vector<int> visible_views;  ///< N  how many views see the point; empty until views are known
};

/// Sharp edges: where the surface is not G1. Seams, degenerate edges and tangent transitions
/// (fillets) are none.
struct Truth {
  Sketch sketch;
  std::vector<int> curve_of_stroke;  ///< one per stroke, into curves: B-splines are several strokes
  std::vector<TruthCurve> curves;
};

/// In the unit frame. Faces that meet at less than `smooth_angle_deg` everywhere along an edge
/// continue one another. B-splines become cubics that share nodes, error below 1e-5.
Truth sharp_edges(const Brep& brep, const UnitFrame& frame, double smooth_angle_deg);

/// The same truth at x * scale + shift.
Truth transformed(const Truth& truth, double scale, const Eigen::Vector3d& shift);

}  // namespace sketchsplat
