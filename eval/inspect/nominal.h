// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// What a drawing calls one edge: strokes that go on as one line, circle, ellipse or smooth spline.
struct NominalEdge {
  std::string name;  ///< "E1", ...: in the order of the strokes
  /// Of all of it: two half circles are a circle. Only circles and ellipses are closed by kind.
  StrokeKind kind = StrokeKind::kLine;
  std::vector<int> strokes;  ///< in their order along the edge
  double length = 0;
};

/// A plane in which a face lies, or several.
struct NominalPlane {
  std::string name;               ///< "P1", ...
  Eigen::Vector3d point, normal;  ///< unit normal, out of the part as far as geometry can tell
  std::vector<int> edges;         ///< that bound its faces, ascending
};

/// The part as it should be, in the user's unit.
struct Nominal {
  std::string name;
  Sketch sketch;
  std::vector<NominalEdge> edges;
  std::vector<int> edge_of_stroke;
  std::vector<NominalPlane> planes;
  double extent = 0;  ///< longest side of its box
};

/// Groups strokes to edges and finds the planes of faces (topology/faces/planar_faces.h).
/// Throws InputError(`name`, ...) if the sketch holds no stroke.
Nominal make_nominal(const Sketch& sketch, const std::string& name);

/// Centre, axis and radius of an edge that is a circle or an arc of one.
struct NominalCircle {
  Eigen::Vector3d centre, normal;
  double radius = 0;
  double angle = 0;  ///< (0, 2 pi] rad that the edge turns by
};
/// False if the edge is none.
bool circle_of(const Nominal& nominal, int edge, NominalCircle* circle);

/// Index of the edge or plane of this name; -1 if there is none.
int find_edge(const Nominal& nominal, const std::string& name);
int find_plane(const Nominal& nominal, const std::string& name);

}  // namespace sketchsplat
