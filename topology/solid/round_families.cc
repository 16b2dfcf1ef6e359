// SPDX-License-Identifier: MIT
#include "topology/solid/round_families.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace sketchsplat {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kRoom = 1.5;  // of the ball around a part: lines are to be followed past it

Surface sphere(const Vector3d& centre, const Vector3d& axis, double radius) {
  return {SurfaceKind::kSphere, centre, axis, radius};
}

}  // namespace

RoundFamily caps(const CircleRim& rim) {
  return [rim](double angle) -> std::optional<RoundPatch> {
    const double rise = rim.radius * std::tan(angle), radius = std::hypot(rim.radius, rise);
    const Vector3d centre = rim.centre + rise * rim.axis;
    const auto above = [rim](const Vector3d& p) { return (p - rim.centre).dot(rim.axis) > 0; };
    const bool flat = rise < 0;  // then the rim is what the cap is wide
    return RoundPatch{sphere(centre, rim.axis, radius), flat ? rim.centre : centre,
                      kRoom * (flat ? rim.radius : radius), above};
  };
}

RoundFamily tips(const CircleRim& rim) {
  return [rim](double angle) -> std::optional<RoundPatch> {
    const double height = rim.radius * std::tan(angle);
    const Surface cone{SurfaceKind::kCone, rim.centre, rim.axis, rim.radius, -1 / std::tan(angle)};
    const auto below_apex = [=](const Vector3d& p) {
      const double up = (p - rim.centre).dot(rim.axis);
      return up > 0 && up < height;
    };
    return RoundPatch{cone, rim.centre + height / 2 * rim.axis,
                      kRoom * std::hypot(rim.radius, height), below_apex};
  };
}

RoundFamily heads(const CircleRim& rim) {
  return [rim](double height) -> std::optional<RoundPatch> {
    const Vector3d centre = rim.centre + height * rim.axis;
    const auto above = [=](const Vector3d& p) { return (p - centre).dot(rim.axis) > 0; };
    return RoundPatch{sphere(centre, rim.axis, rim.radius), centre, kRoom * rim.radius, above};
  };
}

RoundFamily rings(const CircleRim& a, const CircleRim& b) {
  // Radius and height over the first rim.
  const Vector2d p(a.radius, 0), q(b.radius, (b.centre - a.centre).dot(a.axis));
  const Vector2d chord = q - p, middle = (p + q) / 2;
  Vector2d aside = Vector2d(chord.y(), -chord.x()).normalized();
  if (aside.x() < -1e-9 || (aside.x() < 1e-9 && aside.y() < 0)) aside = -aside;
  const double length = chord.norm();
  return [=](double turn) -> std::optional<RoundPatch> {
    const Vector2d out = turn > 0 ? aside : Vector2d(-aside);
    const Vector2d centre = middle - out * (length / 2 / std::tan(std::abs(turn)));
    const double tube = length / 2 / std::sin(std::abs(turn));
    if (!(centre.x() > 1.001 * tube)) return std::nullopt;
    const Vector3d origin = a.centre + centre.y() * a.axis;
    const auto on_arc = [=](const Vector3d& place) {
      const Vector3d from = place - a.centre;
      const double up = from.dot(a.axis);
      const Vector2d in((from - up * a.axis).norm(), up);
      return (in - centre).normalized().dot(out) > std::cos(turn);
    };
    const double widest = std::max(centre.x() + tube, std::max(p.x(), q.x()));
    const Surface torus{SurfaceKind::kTorus, origin, a.axis, centre.x(), 0, tube};
    return RoundPatch{torus, a.centre + middle.y() * a.axis,
                      kRoom * std::hypot(widest, length / 2 + tube), on_arc};
  };
}

std::optional<Bend> bend_of(const CircleRim& a, const CircleRim& b, double tolerance) {
  constexpr double kParallel = 0.1;  // [rad]
  if (std::abs(a.radius - b.radius) > 2 * tolerance) return std::nullopt;
  const Vector3d normal = a.axis.cross(b.axis), between = b.centre - a.centre;
  if (normal.norm() < kParallel) return std::nullopt;
  if (std::abs(between.dot(normal.normalized())) > 2 * tolerance) return std::nullopt;
  const double along = between.cross(b.axis).dot(normal) / normal.squaredNorm();
  Bend bend;
  bend.corner = a.centre + along * a.axis;
  bend.length_a = std::abs(along);
  bend.length_b = (b.centre - bend.corner).norm();
  if (std::min(bend.length_a, bend.length_b) <= 4 * tolerance) return std::nullopt;
  bend.to_a = (a.centre - bend.corner) / bend.length_a;
  bend.to_b = (b.centre - bend.corner) / bend.length_b;
  bend.half = std::acos(std::clamp(bend.to_a.dot(bend.to_b), -1.0, 1.0)) / 2;
  bend.radius = (a.radius + b.radius) / 2;
  return bend;
}

RoundFamily bends(const Bend& bend) {
  return [bend](double radius) -> std::optional<RoundPatch> {
    if (!(radius > 1.001 * bend.radius)) return std::nullopt;
    const double tangent = bend.tangent(radius);
    const Vector3d inwards = (bend.to_a + bend.to_b).normalized();
    const Vector3d centre = bend.corner + inwards * (radius / std::sin(bend.half));
    const auto within = [=](const Vector3d& p) {
      const Vector3d from = p - bend.corner;
      return from.dot(bend.to_a) < tangent && from.dot(bend.to_b) < tangent;
    };
    const Surface torus{
        SurfaceKind::kTorus, centre, bend.to_a.cross(bend.to_b).normalized(), radius, 0,
        bend.radius};
    return RoundPatch{torus, centre - inwards * radius, kRoom * (tangent + bend.radius), within};
  };
}

}  // namespace sketchsplat
