// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "datasets/view.h"

namespace sketchsplat {

enum class RigKind {
  kSphere,    ///< all around, Fibonacci lattice
  kUpper,     ///< above the horizon, Fibonacci lattice
  kRing,      ///< one circle, evenly spaced
  kRandom,    ///< all around, every direction drawn for itself
  kOneSided,  ///< a cone of directions about one that looks down by 35 degrees
};

struct RigOptions {
  RigKind kind = RigKind::kSphere;
  int views = 50;             ///< [1, 100000]
  int resolution = 800;       ///< width and height [px], [16, 8192]
  double focal = 0;           ///< [px]; 0 means 1111.1113654242622 at 800 px, in proportion
  double object_size = 0;     ///< longest side at `distance`, in widths of the image, [0, 10]; sets
                              ///< the focal length in place of `focal`; 0: does not
  double distance = 4.0;      ///< of the cameras from the world origin, extents, [1.6, 1000]
  double elevation_deg = 30;  ///< of a ring, [-85, 85]
  double spread_deg = 45;     ///< half-angle of the cone of a one-sided rig, [1, 180]
};

/// Cameras that look at the origin of the unit frame (centre of the object, whose longest side is
/// 1), z up. As in ABC-NEF they lie on a sphere about the world origin, that is about
/// (-0.5, -0.5, -0.5) of the unit frame: with a distance of 4 they are 3.1 to 4.9 from the object.
/// `seed` turns the lattice. Names are "<k>_colors.png".
std::vector<View> make_rig(const RigOptions& options, std::uint64_t seed);

/// The same cameras seen from a world in which x_world = x * scale + shift.
std::vector<View> transformed(const std::vector<View>& views, double scale,
                              const Eigen::Vector3d& shift);

}  // namespace sketchsplat
