// SPDX-License-Identifier: MIT
#include "topology/solid/surface.h"

#include <algorithm>

namespace sketchsplat {

using Eigen::Matrix2Xd;
using Eigen::Matrix3Xd;
using Eigen::Vector2d;
using Eigen::Vector3d;

Vector3d surface_normal(const Surface& s, const Vector3d& point) {
  const Vector3d from = point - s.origin;
  if (s.kind == SurfaceKind::kPlane) return s.axis;
  if (s.kind == SurfaceKind::kSphere) return from.normalized();
  const Vector3d out = (from - s.axis * from.dot(s.axis)).normalized();
  if (s.kind == SurfaceKind::kCylinder) return out;
  if (s.kind == SurfaceKind::kCone) return (out - s.axis * s.slope).normalized();
  return (from - out * s.radius).normalized();
}

Layout::Layout(const Surface& surface) : surface_(surface) {
  frame_of<double>(surface.axis, &x_, &y_);
  if (surface.kind == SurfaceKind::kPlane) return;
  unit_ = surface.radius;
  period_ = 2 * M_PI * unit_;
}

Vector2d Layout::flat(const Vector3d& point) const {
  const Vector3d from = point - surface_.origin;
  const double x = from.dot(x_), y = from.dot(y_);
  if (period_ == 0) return {x, y};
  return {unit_ * std::atan2(y, x), from.dot(surface_.axis)};
}

Vector3d Layout::point(const Vector2d& flat) const {
  if (period_ == 0) return surface_.origin + x_ * flat.x() + y_ * flat.y();
  const double angle = flat.x() / unit_, radius = surface_.radius + surface_.slope * flat.y();
  return surface_.origin + surface_.axis * flat.y() +
         (x_ * std::cos(angle) + y_ * std::sin(angle)) * radius;
}

Matrix2Xd Layout::flat(const Matrix3Xd& polyline) const {
  Matrix2Xd out(2, polyline.cols());
  for (int i = 0; i < polyline.cols(); ++i) {
    out.col(i) = flat(Vector3d(polyline.col(i)));
    if (i > 0 && period_ > 0)
      out(0, i) += period_ * std::round((out(0, i - 1) - out(0, i)) / period_);
  }
  return out;
}

namespace {

void add_inside(double t, Crossings* out) {
  if (t >= 0 && t <= 1) out->t[out->count++] = t;
}

}  // namespace

Crossings crossings(const Surface& s, const Vector3d& from, const Vector3d& to) {
  const Vector3d p = from - s.origin, d = to - from;
  const double pz = p.dot(s.axis), dz = d.dot(s.axis);
  Crossings out;
  if (s.kind == SurfaceKind::kPlane) {
    if (dz != 0) add_inside(-pz / dz, &out);
    return out;
  }
  // Squared distance from the axis less the squared radius there: a quadratic in t.
  const Vector3d po = p - s.axis * pz, dout = d - s.axis * dz;
  const double r = s.radius + s.slope * pz, dr = s.slope * dz;
  const double a = dout.squaredNorm() - dr * dr, b = po.dot(dout) - r * dr,
               c = po.squaredNorm() - r * r;
  const double root = b * b - a * c;
  if (!(root > 0) || a == 0) return out;
  const double first = (-b - std::sqrt(root)) / a, second = (-b + std::sqrt(root)) / a;
  add_inside(std::min(first, second), &out);
  add_inside(std::max(first, second), &out);
  return out;
}

}  // namespace sketchsplat
