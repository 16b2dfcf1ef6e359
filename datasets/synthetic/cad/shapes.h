// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <functional>
#include <vector>

#include "datasets/synthetic/catalogue/part_table.h"

namespace sketchsplat {

// What built-in parts are made of, in a few words each. Only parts_*.cc include this: it brings
// OpenCASCADE along. Lengths in millimetres.

using Eigen::Vector2d;
using Eigen::Vector3d;

TopoDS_Shape box(const Vector3d& corner, const Vector3d& size);
TopoDS_Shape cylinder(const Vector3d& base, const Vector3d& along, double radius);
TopoDS_Shape cone(const Vector3d& base, const Vector3d& along, double bottom, double top);
TopoDS_Shape ball(const Vector3d& centre, double radius);
/// A quarter of a ring about z, from the x axis to the y axis.
TopoDS_Shape quarter_torus(double ring, double radius);
TopoDS_Shape prism(const TopoDS_Face& face, const Vector3d& along);
TopoDS_Shape prism(const std::vector<Vector3d>& polygon, const Vector3d& along);
TopoDS_Shape pyramid(const Vector3d& apex, const TopoDS_Face& base);
/// A full turn of a face in the xz plane about the z axis.
TopoDS_Shape revolve(const TopoDS_Face& face);
/// About the z axis [rad].
TopoDS_Shape turned(const TopoDS_Shape& shape, double angle);

TopoDS_Shape cut(const TopoDS_Shape& a, const TopoDS_Shape& b);
TopoDS_Shape common(const TopoDS_Shape& a, const TopoDS_Shape& b);
/// Faces that continue one another become one, so that no seam is left where the parts met.
TopoDS_Shape fuse(const TopoDS_Shape& a, const TopoDS_Shape& b);

/// Edges of a shape by their end points.
std::vector<TopoDS_Edge> edges_where(
    const TopoDS_Shape& shape, const std::function<bool(const Vector3d&, const Vector3d&)>& take);
bool vertical(const Vector3d& a, const Vector3d& b);
TopoDS_Shape fillet(const TopoDS_Shape& shape, const std::vector<TopoDS_Edge>& edges, double r);
TopoDS_Shape chamfer(const TopoDS_Shape& shape, const std::vector<TopoDS_Edge>& edges, double d);

/// A planar outline, drawn piece by piece.
class Outline {
 public:
  explicit Outline(const Vector3d& start) : start_(start), at_(start) {}
  Outline& line(const Vector3d& to);
  Outline& arc(const Vector3d& through, const Vector3d& to);
  /// Counter-clockwise about z: centre + cos(t) u + sin(t) v from where the outline stands (t = t0)
  /// to t = t1; u longer than v, at right angles.
  Outline& ellipse(const Vector3d& centre, const Vector3d& u, const Vector3d& v, double t0,
                   double t1);
  /// Interpolates; the outline stands at the first point already, which is not among `points`.
  Outline& spline(const std::vector<Vector3d>& points);
  /// Closes with a line if it is open.
  TopoDS_Face face();

 private:
  Vector3d start_, at_;
  std::vector<TopoDS_Edge> edges_;
};
/// A face within one smooth closed curve through these points (first not repeated).
TopoDS_Face blob(const std::vector<Vector3d>& points);

/// A built-in part: how it is made of its dimensions.
struct PartMaker {
  const char* name;
  TopoDS_Shape (*make)(const Dimensions&);
};
// A part is one entry of part_table.cc, one of these and one function above it.
const std::vector<PartMaker>& prismatic_parts();
const std::vector<PartMaker>& plate_parts();
const std::vector<PartMaker>& thin_parts();
const std::vector<PartMaker>& turned_parts();
const std::vector<PartMaker>& cast_parts();
const std::vector<PartMaker>& freeform_parts();

}  // namespace sketchsplat
