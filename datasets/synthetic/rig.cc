// SPDX-License-Identifier: MIT
#include "datasets/synthetic/rig.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "datasets/synthetic/noise.h"

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

double focal_length(const RigOptions& options) {
  constexpr double kFocalAt800 = 1111.1113654242622;  // of ABC-NEF
  if (options.object_size > 0) return options.object_size * options.resolution * options.distance;
  return options.focal > 0 ? options.focal : kFocalAt800 * options.resolution / 800;
}

Pose looking_at_origin(const Vector3d& centre) {
  const Vector3d forward = -centre.normalized();
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

}  // namespace

std::vector<View> make_rig(const RigOptions& options, std::uint64_t seed) {
  Camera camera;
  camera.width = camera.height = options.resolution;
  camera.fx = camera.fy = focal_length(options);
  camera.cx = camera.cy = (options.resolution - 1) / 2.0;
  const Vector3d to_object = Vector3d::Constant(0.5);  // from the world origin
  std::vector<View> views(options.views);
  for (int k = 0; k < options.views; ++k) {
    const Vector3d d = direction(options, k, seed);
    // Where the ray from the object leaves the sphere |to_object + s d| = distance.
    const double b = to_object.dot(d);
    const double s =
        -b + std::sqrt(b * b - to_object.squaredNorm() + options.distance * options.distance);
    views[k].name = std::to_string(k) + "_colors.png";
    views[k].camera = camera;
    views[k].cam_from_world = looking_at_origin(s * d);
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
