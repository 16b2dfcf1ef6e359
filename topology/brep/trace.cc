// SPDX-License-Identifier: MIT
#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <GeomAPI_Interpolate.hxx>
#include <Geom_BSplineCurve.hxx>
#include <TColgp_HArray1OfPnt.hxx>
#include <algorithm>
#include <cmath>
#include <vector>

#include "datasets/types/dense.h"
#include "sketches/curve/curve.h"
#include "topology/brep/geometry.h"

namespace sketchsplat::brep {
namespace {

using Eigen::Vector3d;

constexpr int kPlaces = 65;
constexpr double kStep = 1e-5;  // of derivatives; of the length of the stroke
// How far the stroke may be from where the surfaces meet; of its length.
constexpr double kAside = 0.1;
// Sine of the angle between surfaces below which it is not known where they meet.
constexpr double kAcross = 0.05;

double distance_from(const Surface& s, const Vector3d& p) {
  return surface_distance<double>(s.kind, s.origin, s.axis, s.radius, s.slope, s.minor_radius, p);
}

// Derivatives of the signed distance, by central differences of a length at which digits are left.
Vector3d gradient(const Surface& surface, const Vector3d& p, double step) {
  Vector3d out;
  for (int k = 0; k < 3; ++k) {
    const Vector3d aside = Vector3d::Unit(k) * step;
    out[k] = (distance_from(surface, p + aside) - distance_from(surface, p - aside)) / (2 * step);
  }
  return out;
}

// The nearest place on both surfaces, by Newton's method.
Vector3d meeting_near(const Surface& a, const Surface& b, Vector3d p, double step) {
  constexpr int kSteps = 20;
  for (int i = 0; i < kSteps; ++i) {
    Eigen::Matrix<double, 2, 3> slope;
    slope << gradient(a, p, step).transpose(), gradient(b, p, step).transpose();
    const Eigen::Vector2d off(distance_from(a, p), distance_from(b, p));
    p -= slope.transpose() * solve_symmetric(slope * slope.transpose(), off);
  }
  return p;
}

// Moved a little so that it begins and ends in the nodes, which other edges share.
Handle(TColgp_HArray1OfPnt)
    between_ends(const Sketch& sketch, int stroke, const std::vector<Vector3d>& places) {
  const Stroke& s = sketch.strokes[stroke];
  const Vector3d first = sketch.nodes.col(s.begin) - places.front(),
                 last = sketch.nodes.col(s.end) - places.back();
  const Handle(TColgp_HArray1OfPnt) points = new TColgp_HArray1OfPnt(1, kPlaces);
  for (int i = 0; i < kPlaces; ++i) {
    const double t = i / (kPlaces - 1.0);
    points->SetValue(i + 1, to_point(places[size_t(i)] + (1 - t) * first + t * last));
  }
  return points;
}

}  // namespace

void trace(const Sketch& sketch, int stroke, double near, const Surface& a, const Surface& b,
           EdgeCurve* curve) {
  // Rims of an extrusion are copies of its profile.
  const bool extruded = a.kind == SurfaceKind::kExtrusion || b.kind == SurfaceKind::kExtrusion;
  if (curve->closed || extruded) return;
  const double length = stroke_length(sketch, stroke);
  std::vector<Vector3d> places;
  double off = 0, aside = 0, left = 0, across = 1;
  for (int i = 0; i < kPlaces; ++i) {
    Vector3d p, d;
    evaluate_stroke(sketch, stroke, i / (kPlaces - 1.0), &p, &d);
    const auto distance = [&](const Vector3d& x) {
      return std::max(std::abs(distance_from(a, x)), std::abs(distance_from(b, x)));
    };
    const Vector3d met = meeting_near(a, b, p, kStep * length);
    off = std::max(off, distance(p));
    left = std::max(left, distance(met));
    aside = std::max(aside, (met - p).norm());
    const double step = kStep * length;
    across = std::min(across, gradient(a, p, step).cross(gradient(b, p, step)).norm());
    places.push_back(met);
  }
  if (off <= near || !(across > kAcross)) return;
  if (!(left <= near) || !(aside <= kAside * length)) return;
  GeomAPI_Interpolate through(between_ends(sketch, stroke, places), /*PeriodicFlag=*/false, 1e-9);
  through.Perform();
  if (!through.IsDone()) throw Refused("an edge cannot be traced");
  const Handle(Geom_BSplineCurve) spline = through.Curve();
  curve->curve = spline;
  curve->first = spline->FirstParameter();
  curve->last = spline->LastParameter();
}

}  // namespace sketchsplat::brep
