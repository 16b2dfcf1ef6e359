// SPDX-License-Identifier: MIT
#include "topology/solid/surface.h"

#include <algorithm>
#include <limits>

#include "sketches/curve/closest.h"
#include "topology/solid/polynomial.h"

namespace sketchsplat {

using Eigen::Matrix2Xd;
using Eigen::Matrix3Xd;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr int kPieces = 128;  // of a profile's polyline

// Moved along the axis.
Vector3d flattened(const Vector3d& p, const Vector3d& axis) { return p - axis * axis.dot(p); }

std::vector<Vector3d> flattened(std::vector<Vector3d> profile, const Vector3d& axis) {
  for (Vector3d& p : profile) p = flattened(p, axis);
  return profile;
}

// The nearest place of a flattened profile, and the profile's direction there.
struct Foot {
  ClosestPoint at;
  Vector3d along;
};
Foot foot_on(StrokeKind kind, const std::vector<Vector3d>& flat, const Vector3d& point) {
  Foot foot;
  foot.at = closest_on_curve(kind, flat.data(), point);
  Vector3d position;
  evaluate_curve<double>(kind, flat.data(), foot.at.t, &position, &foot.along);
  foot.along.normalize();
  return foot;
}

}  // namespace

double surface_distance(const Surface& s, const Vector3d& point) {
  if (s.kind != SurfaceKind::kExtrusion)
    return surface_distance<double>(s.kind, s.origin, s.axis, s.radius, s.slope, s.minor_radius,
                                    point);
  const Vector3d p = flattened(point, s.axis);
  const Foot foot = foot_on(s.profile_kind, flattened(s.profile, s.axis), p);
  return std::copysign(foot.at.distance, (p - foot.at.position).dot(foot.along.cross(s.axis)));
}

Vector3d surface_normal(const Surface& s, const Vector3d& point) {
  const Vector3d from = point - s.origin;
  if (s.kind == SurfaceKind::kPlane) return s.axis;
  if (s.kind == SurfaceKind::kExtrusion)
    return foot_on(s.profile_kind, flattened(s.profile, s.axis), flattened(point, s.axis))
        .along.cross(s.axis)
        .normalized();
  if (s.kind == SurfaceKind::kSphere) return from.normalized();
  const Vector3d out = (from - s.axis * from.dot(s.axis)).normalized();
  if (s.kind == SurfaceKind::kCylinder) return out;
  if (s.kind == SurfaceKind::kCone) return (out - s.axis * s.slope).normalized();
  return (from - out * s.radius).normalized();
}

Layout::Layout(const Surface& surface, bool around_tube)
    : surface_(surface), around_tube_(around_tube && surface.kind == SurfaceKind::kTorus) {
  frame_of<double>(surface.axis, &x_, &y_);
  if (surface.kind == SurfaceKind::kPlane) return;
  if (surface.kind == SurfaceKind::kExtrusion) {
    surface_.profile = flattened(surface.profile, surface.axis);
    profile_.resize(2, kPieces + 1);
    length_ = Eigen::VectorXd::Zero(kPieces + 1);
    Vector3d p, along;
    for (int i = 0; i <= kPieces; ++i) {
      evaluate_curve<double>(surface.profile_kind, surface_.profile.data(), double(i) / kPieces, &p,
                             &along);
      profile_.col(i) = Vector2d(p.dot(x_), p.dot(y_));
      if (i > 0) length_[i] = length_[i - 1] + (profile_.col(i) - profile_.col(i - 1)).norm();
    }
    if (is_closed(surface.profile_kind)) period_.x() = length_[kPieces];
    return;
  }
  unit_.x() = surface.radius;
  if (surface.kind == SurfaceKind::kSphere) unit_.y() = surface.radius;
  if (surface.kind == SurfaceKind::kTorus) unit_.y() = surface.minor_radius;
  if (around_tube_) std::swap(unit_.x(), unit_.y());
  period_.x() = 2 * M_PI * unit_.x();
  if (surface.kind == SurfaceKind::kTorus) period_.y() = 2 * M_PI * unit_.y();
}

double Layout::pole(int side) const {
  if (surface_.kind == SurfaceKind::kSphere) return side * M_PI / 2 * surface_.radius;
  if (surface_.kind == SurfaceKind::kCone && surface_.slope * side < 0)
    return -surface_.radius / surface_.slope;
  return std::numeric_limits<double>::quiet_NaN();
}

Vector2d Layout::flat_of_extrusion(const Vector3d& point) const {
  const Vector3d p = flattened(point, surface_.axis);
  const Foot foot = foot_on(surface_.profile_kind, surface_.profile, p);
  const double x = foot.at.t * kPieces;
  const int i = std::min(int(x), kPieces - 1);
  double along = length_[i] + (x - i) * (length_[i + 1] - length_[i]);
  if (period_.x() > 0)
    return {along - period_.x() * std::round(along / period_.x()), point.dot(surface_.axis)};
  if (foot.at.t <= 0 || foot.at.t >= 1) along += (p - foot.at.position).dot(foot.along);
  return {along, point.dot(surface_.axis)};
}

Vector2d Layout::flat(const Vector3d& point) const {
  if (surface_.kind == SurfaceKind::kExtrusion) return flat_of_extrusion(point);
  const Vector3d from = point - surface_.origin;
  const double x = from.dot(x_), y = from.dot(y_), z = from.dot(surface_.axis);
  if (surface_.kind == SurfaceKind::kPlane) return {x, y};
  const double around = std::atan2(y, x);
  if (surface_.kind == SurfaceKind::kSphere)
    return {unit_.x() * around, unit_.y() * std::atan2(z, std::hypot(x, y))};
  if (surface_.kind != SurfaceKind::kTorus) return {unit_.x() * around, z};
  const double tube = std::atan2(z, std::hypot(x, y) - surface_.radius);
  if (around_tube_) return {unit_.x() * tube, -unit_.y() * around};
  return {unit_.x() * around, unit_.y() * tube};
}

Vector3d Layout::point(const Vector2d& flat) const {
  if (surface_.kind == SurfaceKind::kPlane) return surface_.origin + x_ * flat.x() + y_ * flat.y();
  if (surface_.kind == SurfaceKind::kExtrusion) {
    double along = flat.x();
    if (period_.x() > 0) along -= period_.x() * std::floor(along / period_.x());
    const double* end = length_.data() + kPieces;
    const int i = int(std::upper_bound(length_.data() + 1, end, along) - length_.data()) - 1;
    const double share = (along - length_[i]) / (length_[i + 1] - length_[i]);
    const Vector2d p = profile_.col(i) + share * (profile_.col(i + 1) - profile_.col(i));
    return x_ * p.x() + y_ * p.y() + surface_.axis * flat.y();
  }
  double around = flat.x() / unit_.x(), second = flat.y() / unit_.y();
  if (around_tube_) {
    std::swap(around, second);
    around = -around;
  }
  double out = surface_.radius + surface_.slope * flat.y(), up = flat.y();
  if (surface_.kind == SurfaceKind::kSphere) {
    out = surface_.radius * std::cos(second);
    up = surface_.radius * std::sin(second);
  } else if (surface_.kind == SurfaceKind::kTorus) {
    out = surface_.radius + surface_.minor_radius * std::cos(second);
    up = surface_.minor_radius * std::sin(second);
  }
  return surface_.origin + surface_.axis * up +
         (x_ * std::cos(around) + y_ * std::sin(around)) * out;
}

Matrix2Xd Layout::flat(const Matrix3Xd& polyline) const {
  Matrix2Xd out(2, polyline.cols());
  for (int i = 0; i < polyline.cols(); ++i) {
    out.col(i) = flat(Vector3d(polyline.col(i)));
    for (int k = 0; k < 2 && i > 0; ++k)
      if (period_[k] > 0)
        out(k, i) += period_[k] * std::round((out(k, i - 1) - out(k, i)) / period_[k]);
  }
  return out;
}

namespace {

void add_inside(double t, Crossings* out) {
  if (t >= 0 && t <= 1) out->t[out->count++] = t;
}

// Roots of a t^2 + 2 b t + c.
Crossings roots_of(double a, double b, double c) {
  Crossings out;
  const double root = b * b - a * c;
  if (!(root > 0) || a == 0) return out;
  const double first = (-b - std::sqrt(root)) / a, second = (-b + std::sqrt(root)) / a;
  add_inside(std::min(first, second), &out);
  add_inside(std::max(first, second), &out);
  return out;
}

// With s the length from the foot of the centre's perpendicular on the line, q the squared distance
// from the centre and h the height, a torus is (q + R^2 - r^2)^2 = 4 R^2 (q - h^2).
Crossings torus_crossings(const Surface& surface, const Vector3d& from, const Vector3d& to) {
  const double length = (to - from).norm();
  const Vector3d along = (to - from) / length;
  const double foot = (surface.origin - from).dot(along);
  const Vector3d p = from + foot * along - surface.origin;
  const double big = surface.radius, small = surface.minor_radius, reach = big + small;
  Crossings out;
  const double p2 = p.squaredNorm();
  if (!(length > 0) || p2 > reach * reach) return out;
  const double h = p.dot(surface.axis), dh = along.dot(surface.axis);
  const double k = p2 + big * big - small * small, r4 = 4 * big * big;
  const double half = std::sqrt(reach * reach - p2) * (1 + 1e-9);
  const std::vector<double> quartic = {k * k - r4 * (p2 - h * h), 2 * r4 * h * dh,
                                       2 * k - r4 * (1 - dh * dh), 0, 1};
  for (const double s : roots_between(quartic, -half, half)) add_inside((foot + s) / length, &out);
  return out;
}

Crossings extrusion_crossings(const Layout& layout, const Vector3d& from, const Vector3d& to) {
  Vector3d x, y;
  frame_of<double>(layout.surface().axis, &x, &y);
  const Vector2d p(from.dot(x), from.dot(y)), d = Vector2d(to.dot(x), to.dot(y)) - p;
  const Matrix2Xd& profile = layout.profile();
  const auto side = [&](int i) {
    const Vector2d q = profile.col(i) - p;
    return d.x() * q.y() - d.y() * q.x();
  };
  Crossings out;
  double last = side(0);
  for (int i = 1; i < profile.cols() && out.count < Crossings::kMost; ++i) {
    const double here = side(i);
    if ((last < 0) != (here < 0)) {
      const Vector2d q =
          profile.col(i - 1) + last / (last - here) * (profile.col(i) - profile.col(i - 1));
      add_inside((q - p).dot(d) / d.squaredNorm(), &out);
    }
    last = here;
  }
  std::sort(out.t, out.t + out.count);
  return out;
}

}  // namespace

Crossings crossings(const Layout& layout, const Vector3d& from, const Vector3d& to) {
  const Surface& s = layout.surface();
  if (s.kind == SurfaceKind::kExtrusion) return extrusion_crossings(layout, from, to);
  if (s.kind == SurfaceKind::kTorus) return torus_crossings(s, from, to);
  const Vector3d p = from - s.origin, d = to - from;
  if (s.kind == SurfaceKind::kSphere)
    return roots_of(d.squaredNorm(), p.dot(d), p.squaredNorm() - s.radius * s.radius);
  const double pz = p.dot(s.axis), dz = d.dot(s.axis);
  Crossings out;
  if (s.kind == SurfaceKind::kPlane) {
    if (dz != 0) add_inside(-pz / dz, &out);
    return out;
  }
  // Squared distance from the axis less the squared radius there: a quadratic in t.
  const Vector3d po = p - s.axis * pz, dout = d - s.axis * dz;
  const double r = s.radius + s.slope * pz, dr = s.slope * dz;
  return roots_of(dout.squaredNorm() - dr * dr, po.dot(dout) - r * dr, po.squaredNorm() - r * r);
}

}  // namespace sketchsplat
