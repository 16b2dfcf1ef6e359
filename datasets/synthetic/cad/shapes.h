// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "datasets/synthetic/catalogue/part_table.h"

namespace sketchsplat {

// What built-in parts are made of, in a few words each. Only parts_*.cc include this: it brings
// OpenCASCADE along. Lengths in millimetres, angles in radians.

using Eigen::Vector2d;
using Eigen::Vector3d;

TopoDS_Shape box(const Vector3d& corner, const Vector3d& size);
/// From the origin; the second one of the dimensions length, width and height.
TopoDS_Shape box(const Vector3d& size);
TopoDS_Shape box(const Dimensions& d);
TopoDS_Shape cylinder(const Vector3d& base, const Vector3d& along, double radius);
TopoDS_Shape cone(const Vector3d& base, const Vector3d& along, double bottom, double top);
TopoDS_Shape ball(const Vector3d& centre, double radius);
/// A quarter of a ring about z, from the x axis to the y axis.
TopoDS_Shape quarter_torus(double ring, double radius);
TopoDS_Shape pyramid(const Vector3d& apex, const TopoDS_Face& base);
TopoDS_Shape prism(const TopoDS_Face& face, const Vector3d& along);
/// A full turn of a face in the xz plane about the z axis.
TopoDS_Shape revolve(const TopoDS_Face& face);
/// About the z axis.
TopoDS_Shape turned(const TopoDS_Shape& shape, double angle);

TopoDS_Shape cut(const TopoDS_Shape& a, const TopoDS_Shape& b);
TopoDS_Shape common(const TopoDS_Shape& a, const TopoDS_Shape& b);
/// Faces that continue one another become one, so that no seam is left where the parts met.
TopoDS_Shape fuse(const TopoDS_Shape& a, const TopoDS_Shape& b);
/// A hole along z at (x, y) through what lies between z = 0 and `height`.
TopoDS_Shape drilled(const TopoDS_Shape& shape, double x, double y, double height, double radius);
/// Such holes evenly spaced about z, `at` from it.
TopoDS_Shape drilled_around(TopoDS_Shape shape, int count, double at, double height, double radius);

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

/// A place that a profile goes to: in a straight line, or `kThrough` it by an arc to the next one.
struct To {
  double x, y;
  bool through = false;
};
constexpr bool kThrough = true;
/// The face within a closed profile whose places are `right` x + `up` y.
TopoDS_Face profile(const Vector3d& right, const Vector3d& up, const std::vector<To>& places);
/// Profiles of (y, z) along x from 0 to `length`, of (x, z) along y, of (x, y) along z from `z`,
/// and of (x, z) turned about z.
TopoDS_Shape along_x(const std::vector<To>& places, double length);
TopoDS_Shape along_y(const std::vector<To>& places, double length);
TopoDS_Shape along_z(const std::vector<To>& places, double z, double length);
TopoDS_Shape lathed(const std::vector<To>& places);

/// How the parts of a kind are made, by name, of dimensions in model units: lengths in millimetres,
/// whatever they are relative to in the table, and angles in radians. A part is one entry of
/// part_table.cc, one of these and one function above it.
using PartMakers = std::map<std::string, TopoDS_Shape (*)(const Dimensions&)>;
const PartMakers& prismatic_parts();
const PartMakers& plate_parts();
const PartMakers& turned_parts();
const PartMakers& smooth_parts();

}  // namespace sketchsplat
