// SPDX-License-Identifier: MIT
#include "datasets/synthetic/render/rig.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "datasets/synthetic/render/noise.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

Vector3d on_sphere(double z, double azimuth) {
  const double r = std::sqrt(std::max(0.0, 1 - z * z));
  return {r * std::cos(azimuth), r * std::sin(azimuth), z};
}

// From the z axis to the middle of a one-sided rig.
Eigen::Matrix3d one_side(double turn) {
  constexpr double kElevation = 35 * M_PI / 180;
  return (Eigen::AngleAxisd(2 * M_PI * turn, Vector3d::UnitZ()) *
          Eigen::AngleAxisd(M_PI / 2 - kElevation, Vector3d::UnitY()))
      .toRotationMatrix();
}

// Direction from the object to camera k. Fibonacci lattice: Gonzalez, "Measurement of areas on a
// sphere using Fibonacci and latitude-longitude lattices", 2010.
Vector3d direction(const RigOptions& options, int k, std::uint64_t seed) {
  const double turn = uniform(hash(seed, 0, 0, 7));
  const double share = (k + 0.5) / options.views;
  const double golden = 2 * M_PI * (k * (std::sqrt(5.0) - 1) / 2 + turn);
  switch (options.kind) {
    case RigKind::kRing:
      return on_sphere(std::sin(options.elevation_deg * M_PI / 180), 2 * M_PI * (share + turn));
    case RigKind::kRandom:
      return on_sphere(2 * uniform(hash(seed, k, 0, 40)) - 1,
                       2 * M_PI * uniform(hash(seed, k, 1, 40)));
    case RigKind::kOneSided: {
      const double lowest = std::cos(options.spread_deg * M_PI / 180);
      return one_side(turn) * on_sphere(lowest + (1 - lowest) * share, golden);
    }
    default: {
      const double lowest = options.kind == RigKind::kUpper ? 0.05 : -1.0;
      return on_sphere(lowest + (1 - lowest) * share, golden);
    }
  }
}

Pose looking_at(const Vector3d& target, const Vector3d& centre) {
  const Vector3d forward = (target - centre).normalized();
  Vector3d right = forward.cross(Vector3d::UnitZ());
  if (right.norm() < 1e-6) right = forward.cross(Vector3d::UnitY());
  right.normalize();
  Pose pose;  // cam_from_world
  pose.rotation.row(0) = right;
  pose.rotation.row(1) = forward.cross(right);
  pose.rotation.row(2) = forward;
  pose.translation = -(pose.rotation * centre);
  return pose;
}

// As somebody who walks around a table with a camera holds it.
Pose held_by_hand(const RigOptions& options, int k, std::uint64_t seed) {
  const auto waver = [&](int use) { return 2 * uniform(hash(seed, k, use, 41)) - 1; };
  constexpr double kLow = 14 * M_PI / 180, kHigh = 60 * M_PI / 180;
  const double share = (k + 0.5) / options.views, golden = (std::sqrt(5.0) - 1) / 2;
  const double z = std::sin(kLow) + (std::sin(kHigh) - std::sin(kLow)) * share;
  const double turn = uniform(hash(seed, 0, 0, 7));
  const Vector3d d = on_sphere(z, 2 * M_PI * (k * golden + turn) + 0.1 * waver(0));
  const Vector3d target(0.08 * waver(1), 0.08 * waver(2), 0.08 * waver(3));
  Pose pose = looking_at(target, options.distance * (1 + 0.08 * waver(4)) * d);
  const Eigen::Matrix3d roll =
      Eigen::AngleAxisd(0.08 * waver(5), Vector3d::UnitZ()).toRotationMatrix();
  return {roll * pose.rotation, roll * pose.translation};
}

}  // namespace

std::vector<View> make_rig(const RigOptions& given, std::uint64_t seed) {
  const RigOptions options = resolved(given, /*photographs=*/false);
  Camera camera;
  camera.width = options.resolution;
  camera.height = options.height;
  camera.fx = camera.fy = options.focal;
  camera.cx = (camera.width - 1) / 2.0;
  camera.cy = (camera.height - 1) / 2.0;
  const Vector3d to_object = Vector3d::Constant(0.5);  // from the world origin
  std::vector<View> views(options.views);
  for (int k = 0; k < options.views; ++k) {
    views[k].name = std::to_string(k) + "_colors.png";
    views[k].camera = camera;
    if (options.kind == RigKind::kHemisphere) {
      views[k].cam_from_world = held_by_hand(options, k, seed);
      continue;
    }
    const Vector3d d = direction(options, k, seed);
    // Where the ray from the object leaves the sphere |to_object + s d| = distance.
    const double b = to_object.dot(d);
    const double s =
        -b + std::sqrt(b * b - to_object.squaredNorm() + options.distance * options.distance);
    views[k].cam_from_world = looking_at(Vector3d::Zero(), s * d);
  }
  return views;
}

std::vector<View> transformed(const std::vector<View>& views, double scale, const Vector3d& shift) {
  std::vector<View> out = views;
  for (View& view : out) {
    Pose& pose = view.cam_from_world;
    pose.translation = pose.translation * scale - pose.rotation * shift;
  }
  return out;
}

}  // namespace sketchsplat
