// SPDX-License-Identifier: MIT
#include "topology/brep/geometry.h"

#include <Eigen/Geometry>
#include <GeomConvert.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BezierCurve.hxx>
#include <Geom_Circle.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Ellipse.hxx>
#include <Geom_Line.hxx>
#include <Geom_Plane.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_SurfaceOfLinearExtrusion.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <algorithm>
#include <cmath>

#include "datasets/types/dense.h"
#include "sketches/curve/conic.h"
#include "sketches/curve/curve.h"
#include "sketches/io/step_file.h"

namespace sketchsplat::brep {
namespace {

using Eigen::Vector3d;

EdgeCurve line_between(const Vector3d& begin, const Vector3d& end) {
  const double length = (end - begin).norm();
  if (!(length > 1e-9)) throw Refused("an edge has no length");
  return {new Geom_Line(to_point(begin), to_direction((end - begin) / length)), 0, length, false};
}

Handle(Geom_Curve)
    circle(const Vector3d& centre, const Vector3d& normal, const Vector3d& x, double radius) {
  return new Geom_Circle(gp_Ax2(to_point(centre), to_direction(normal), to_direction(x)), radius);
}

Handle(Geom_Curve) ellipse(const Vector3d& centre, const EllipseAxes& axes) {
  const double major = axes.major.norm(), minor = axes.minor.norm();
  if (!(minor > 1e-9)) throw Refused("an ellipse has no width");
  const gp_Ax2 frame(to_point(centre), to_direction(axes.major.cross(axes.minor).normalized()),
                     to_direction(axes.major / major));
  return new Geom_Ellipse(frame, std::max(major, minor), minor);
}

EdgeCurve arc(const Sketch& sketch, int stroke, const ControlPoints& c, double flat) {
  const CircleParameters k = circle_parameters(sketch, stroke);
  const double sagitta = k.straight ? 0 : 2 * k.radius * std::pow(std::sin(k.angle / 4), 2);
  if (!(sagitta > flat)) return line_between(c.p[0], c.p[2]);
  return {circle(k.centre, k.normal, (c.p[0] - k.centre).normalized(), k.radius), 0, k.angle,
          false};
}

EdgeCurve elliptic(const ControlPoints& c, double flat) {
  const EllipticArcParameters e = elliptic_arc_parameters(c);
  const Vector3d rise = c.p[1] - (c.p[0] + c.p[3]) / 2;
  if (e.straight || !(rise.norm() > flat)) return line_between(c.p[0], c.p[3]);
  double turn = 0;
  const EllipseAxes axes = principal_axes(e.p, e.q, &turn);
  return {ellipse(e.centre, axes), -e.half_angle - turn, e.half_angle - turn, false};
}

EdgeCurve cubic(const ControlPoints& c) {
  TColgp_Array1OfPnt poles(1, 4);
  for (int i = 0; i < 4; ++i) poles(i + 1) = to_point(c.p[i]);
  const Handle(Geom_BezierCurve) bezier = new Geom_BezierCurve(poles);
  return {GeomConvert::CurveToBSplineCurve(bezier), 0, 1, false};
}

// Along the axis of a sphere, in radii: how near the border comes to a pole, and how far it climbs
// up and down in all.
struct Heights {
  double highest = 0, climbed = 0;
};
Heights heights_of(const std::vector<Vector3d>& border, const Surface& sphere,
                   const Vector3d& axis) {
  Heights out;
  double last = NAN;
  for (const Vector3d& p : border) {
    const double height = axis.dot(p - sphere.origin) / sphere.radius;
    out.highest = std::max(out.highest, std::abs(height));
    if (!std::isnan(last)) out.climbed += std::abs(height - last);
    last = height;
  }
  return out;
}

// Poles are where parameters mean nothing, so they stay away from the border; and circles about the
// axis are lines in parameters, others splines.
Vector3d sphere_axis(const Surface& surface, const std::vector<Vector3d>& border) {
  std::vector<Vector3d> candidates = {surface.axis};
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = 0; z <= 1; ++z)
        if (x != 0 || y != 0 || z != 0) candidates.push_back(Vector3d(x, y, z).normalized());
  // Normal of a circle, and directions square to it.
  if (!border.empty()) {
    Vector3d mean = Vector3d::Zero();
    for (const Vector3d& p : border) mean += p / double(border.size());
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Vector3d& p : border) spread += (p - mean) * (p - mean).transpose();
    const Eigen::Matrix3d principal = eigen_symmetric(spread).vectors;
    for (int k = 0; k < 3; ++k) candidates.push_back(principal.col(k));
  }
  constexpr double kNearPole = 0.99;
  const auto price = [&](const Vector3d& axis) {
    const Heights h = heights_of(border, surface, axis);
    return std::pair(h.highest > kNearPole ? h.highest : 0, h.climbed);
  };
  return *std::min_element(
      candidates.begin(), candidates.end(),
      [&](const Vector3d& a, const Vector3d& b) { return price(a) < price(b); });
}

Handle(Geom_Surface) cone(const Surface& s, const std::vector<Vector3d>& border) {
  double along = 0;
  for (const Vector3d& p : border) along += (p - s.origin).dot(s.axis) / double(border.size());
  const double radius = s.radius + s.slope * along;
  // Beyond the apex the radius grows again, the other way.
  const double slope = radius < 0 ? -s.slope : s.slope;
  const Vector3d axis = slope > 0 ? s.axis : Vector3d(-s.axis);
  const Vector3d origin = s.origin + along * s.axis;
  if (!std::isfinite(radius + slope) || !(std::abs(radius) > 1e-9) || !(std::abs(slope) > 1e-9))
    throw Refused("a cone has no slope");
  const gp_Ax3 frame(to_point(origin), to_direction(axis),
                     to_direction(step::plain_direction(axis)));
  return new Geom_ConicalSurface(frame, std::atan(std::abs(slope)), std::abs(radius));
}

// The profile as if it were the one stroke of a sketch.
Sketch sketch_of(const Surface& s) {
  Sketch sketch;
  std::vector<Vector3d> handles = s.profile;
  if (int(handles.size()) != num_controls(s.profile_kind)) throw Refused("it has no profile");
  int begin = -1, end = -1;
  if (!is_closed(s.profile_kind)) {
    begin = sketch.add_node(handles.front());
    end = sketch.add_node(handles.back());
    handles.erase(handles.begin());
    handles.pop_back();
  }
  sketch.add_stroke(s.profile_kind, begin, end, handles);
  return sketch;
}

}  // namespace

EdgeCurve curve_of(const Sketch& sketch, int stroke, double flat) {
  const ControlPoints c = control_points(sketch, stroke);
  switch (sketch.strokes[stroke].kind) {
    case StrokeKind::kLine:
      return line_between(c.p[0], c.p[1]);
    case StrokeKind::kArc:
      return arc(sketch, stroke, c, flat);
    case StrokeKind::kCircle: {
      const CircleParameters k = circle_parameters(sketch, stroke);
      if (!(k.radius > 1e-9)) throw Refused("a circle has no radius");
      const Vector3d x = step::plain_direction(k.normal);
      return {circle(k.centre, k.normal, x, k.radius), 0, 2 * M_PI, true};
    }
    case StrokeKind::kEllipse:
      return {ellipse(c.p[0], principal_axes(c.p[1], c.p[2])), 0, 2 * M_PI, true};
    case StrokeKind::kBezier:
      return cubic(c);
    case StrokeKind::kEllipticArc:
      return elliptic(c, flat);
  }
  throw Refused("a curve is of no kind");
}

Handle(Geom_Surface) surface_of(const Surface& s, const std::vector<Vector3d>& border) {
  const bool round = s.kind != SurfaceKind::kPlane && s.kind != SurfaceKind::kCone &&
                     s.kind != SurfaceKind::kExtrusion;
  const auto is_length = [](double x) { return std::isfinite(x) && x > 1e-9; };
  if (!s.origin.allFinite() || !(std::abs(s.axis.norm() - 1) < 1e-6))
    throw Refused("a surface has no axis");
  if (round && !is_length(s.radius)) throw Refused("a surface has no radius");
  const Vector3d axis = s.kind == SurfaceKind::kSphere ? sphere_axis(s, border) : s.axis;
  const gp_Ax3 frame(to_point(s.origin), to_direction(axis),
                     to_direction(step::plain_direction(axis)));
  switch (s.kind) {
    case SurfaceKind::kPlane:
      return new Geom_Plane(frame);
    case SurfaceKind::kCylinder:
      return new Geom_CylindricalSurface(frame, s.radius);
    case SurfaceKind::kCone:
      return cone(s, border);
    case SurfaceKind::kSphere:
      return new Geom_SphericalSurface(frame, s.radius);
    case SurfaceKind::kTorus:
      if (!is_length(s.minor_radius) || !(s.minor_radius < s.radius))
        throw Refused("a torus runs through itself");
      return new Geom_ToroidalSurface(frame, s.radius, s.minor_radius);
    case SurfaceKind::kExtrusion:
      return new Geom_SurfaceOfLinearExtrusion(curve_of(sketch_of(s), 0, 0).curve,
                                               frame.Direction());
  }
  throw Refused("a surface is of no kind");
}

}  // namespace sketchsplat::brep
