// SPDX-License-Identifier: MIT
#include "topology/solid/find_surfaces.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "sketches/curve/conic.h"
#include "sketches/curve/curve.h"
#include "topology/faces/find_planes.h"
#include "topology/solid/circle_rim.h"
#include "topology/solid/surface.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

struct Round : CircleRim {
  int stroke;
};

bool lies_on(const Surface& surface, const Matrix3Xd& polyline, double tolerance) {
  // The middle of a line, too: its ends may be those of a chord.
  if (polyline.cols() == 2 &&
      std::abs(surface_distance(surface, polyline.rowwise().mean())) > tolerance)
    return false;
  for (int i = 0; i < polyline.cols(); ++i)
    if (std::abs(surface_distance(surface, polyline.col(i))) > tolerance) return false;
  return true;
}

bool on_one_level(const Surface& surface, const std::vector<Matrix3Xd>& polylines,
                  const std::vector<int>& strokes, double tolerance) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const int s : strokes) {
    const Eigen::VectorXd z = (polylines[s].colwise() - surface.origin).transpose() * surface.axis;
    low = std::min(low, z.minCoeff());
    high = std::max(high, z.maxCoeff());
  }
  return high - low <= 4 * tolerance;
}

class Finder {
 public:
  Finder(const Sketch& sketch, const std::vector<Matrix3Xd>& polylines, double tolerance)
      : sketch_(sketch), polylines_(polylines), tolerance_(tolerance) {
    for (int s = 0; s < sketch.size(); ++s)
      if (const std::optional<CircleRim> rim = circle_rim(sketch, s, tolerance))
        rounds_.push_back({*rim, s});
  }

  std::vector<SurfaceStrokes> find() {
    for (const PlaneStrokes& p : find_planes(sketch_, polylines_, tolerance_)) {
      Surface plane;
      plane.origin = p.plane.origin;
      plane.axis = p.plane.normal;
      add(plane, p.strokes);
    }
    for (const Round& round : rounds_) {
      Surface s;
      s.kind = SurfaceKind::kCylinder;
      s.origin = round.centre;
      s.axis = round.axis;
      s.radius = round.radius;
      add_turned(s);
    }
    for (int s = 0; s < sketch_.size(); ++s)
      if (sketch_.strokes[s].kind == StrokeKind::kEllipse) add_cut_cylinders(s);
    for (const Round& a : rounds_)
      for (const Round& b : rounds_)
        if (a.stroke < b.stroke) add_cone(a, b);
    for (const Round& round : rounds_)
      for (int s = 0; s < sketch_.size(); ++s)
        if (s != round.stroke && sketch_.strokes[s].kind != StrokeKind::kLine)
          add_cone_through(round, s);
    return std::move(found_);
  }

 private:
  void add(const Surface& surface, const std::vector<int>& strokes) {
    const bool planar = surface.kind == SurfaceKind::kPlane;
    if (strokes.size() + (planar ? 1 : 0) < 2 || !seen_[planar].insert(strokes).second) return;
    found_.push_back({surface, strokes});
  }

  void add_turned(const Surface& surface) {
    const std::vector<int> on = strokes_on(surface, polylines_, tolerance_);
    if (!on_one_level(surface, polylines_, on, tolerance_)) add(surface, on);
  }

  // The two cylinders that a plane cuts in this ellipse.
  void add_cut_cylinders(int stroke) {
    const ControlPoints c = control_points(sketch_, stroke);
    const EllipseAxes axes = principal_axes(c.p[1], c.p[2]);
    const double a = axes.major.norm(), b = axes.minor.norm();
    if (!(b > 4 * tolerance_)) return;
    const Vector3d normal = axes.major.cross(axes.minor).normalized();
    const double cosine = b / a, sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    for (const double sign : {-1.0, 1.0}) {
      Surface s;
      s.kind = SurfaceKind::kCylinder;
      s.origin = c.p[0];
      s.axis = normal * cosine + axes.major / a * (sign * sine);
      s.radius = b;
      add_turned(s);
    }
  }

  void add_cone(const Round& a, const Round& b) {
    const double along = (b.centre - a.centre).dot(a.axis);
    if (!coaxial(a, b, tolerance_) || std::abs(along) <= 4 * tolerance_) return;
    if (std::abs(a.radius - b.radius) <= 4 * tolerance_) return;
    Surface s;
    s.kind = SurfaceKind::kCone;
    s.origin = a.centre;
    s.axis = a.axis;
    s.radius = a.radius;
    s.slope = (b.radius - a.radius) / along;
    add_turned(s);
  }

  // The cone about the axis of a round on which a stroke of another plane lies, too: a chamfer that
  // flat sides cut.
  void add_cone_through(const Round& round, int stroke) {
    const Matrix3Xd from = polylines_[stroke].colwise() - round.centre;
    Eigen::Index far;
    const double most = (from.transpose() * round.axis).cwiseAbs().maxCoeff(&far);
    if (most <= 4 * tolerance_) return;
    const double along = from.col(far).dot(round.axis);
    const double radius = (from.col(far) - along * round.axis).norm();
    if (std::abs(radius - round.radius) <= 4 * tolerance_) return;
    Surface s;
    s.kind = SurfaceKind::kCone;
    s.origin = round.centre;
    s.axis = round.axis;
    s.radius = round.radius;
    s.slope = (radius - round.radius) / along;
    if (lies_on(s, polylines_[stroke], tolerance_)) add_turned(s);
  }

  const Sketch& sketch_;
  const std::vector<Matrix3Xd>& polylines_;
  double tolerance_;
  std::vector<Round> rounds_;
  std::set<std::vector<int>> seen_[2];  // turned, planar
  std::vector<SurfaceStrokes> found_;
};

}  // namespace

std::vector<int> strokes_on(const Surface& surface, const std::vector<Matrix3Xd>& polylines,
                            double tolerance) {
  std::vector<int> out;
  for (int s = 0; s < int(polylines.size()); ++s)
    if (lies_on(surface, polylines[s], tolerance)) out.push_back(s);
  return out;
}

std::vector<SurfaceStrokes> find_surfaces(const Sketch& sketch,
                                          const std::vector<Matrix3Xd>& polylines,
                                          double tolerance) {
  return Finder(sketch, polylines, tolerance).find();
}

}  // namespace sketchsplat
