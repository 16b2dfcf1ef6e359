// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "datasets/types/view.h"

namespace sketchsplat {

enum class RigKind {
  kSphere,    ///< all around, Fibonacci lattice
  kUpper,     ///< above the horizon, Fibonacci lattice
  kRing,      ///< one circle, evenly spaced
  kRandom,    ///< all around, every direction drawn for itself
  kOneSided,  ///< a cone of directions about one that looks down by 35 degrees
  kHemisphere,  ///< as by hand: about the object, 14 to 60 degrees above its table, none quite even
  kAuto,        ///< a hemisphere for photographs, else a sphere
};

struct RigOptions {
  RigKind kind = RigKind::kAuto;
  int views = 50;             ///< [1, 100000]
  int resolution = 800;       ///< width [px], [16, 8192]
  int height = 0;  ///< [px], [16, 8192]; 0: the width, of photographs three quarters of it
  double focal = 0;           ///< [px]; 0 means 1111.1113654242622 at 800 px, in proportion; for
                              ///< photographs 1.15 times the width
  double object_size = 0;     ///< longest side at `distance`, in widths of the image, [0, 10]; sets
                              ///< the focal length in place of `focal`; 0: does not
  double distance = 0;        ///< of the cameras from the world origin, of a hemisphere from the
                              ///< object's middle, extents, [1.6, 1000]; 0: 4, for photographs 2.6
  double elevation_deg = 30;  ///< of a ring, [-85, 85]
  double spread_deg = 45;     ///< half-angle of the cone of a one-sided rig, [1, 180]
};

/// The options with a number in place of every 0 that stands for one, and of RigKind::kAuto; then
/// `focal` holds what `object_size` asks for, too.
inline RigOptions resolved(RigOptions options, bool photographs) {
  constexpr double kFocalAt800 = 1111.1113654242622;  // of ABC-NEF
  const int w = options.resolution;
  if (options.kind == RigKind::kAuto)
    options.kind = photographs ? RigKind::kHemisphere : RigKind::kSphere;
  if (options.height == 0) options.height = photographs ? w * 3 / 4 : w;
  if (options.distance == 0) options.distance = photographs ? 2.6 : 4.0;
  if (options.object_size > 0) options.focal = options.object_size * w * options.distance;
  if (options.focal == 0) options.focal = photographs ? 1.15 * w : kFocalAt800 * w / 800;
  return options;
}

/// Cameras that look at the origin of the unit frame (centre of the object, whose longest side is
/// 1), z up. As in ABC-NEF they lie on a sphere about the world origin, that is about
/// (-0.5, -0.5, -0.5) of the unit frame: with a distance of 4 they are 3.1 to 4.9 from the object.
/// `seed` turns the lattice. Names are "<k>_colors.png". Those of a hemisphere are as far from the
/// object as from the world origin; distances, aims and the horizon waver.
std::vector<View> make_rig(const RigOptions& options, std::uint64_t seed);

/// The same cameras seen from a world in which x_world = x * scale + shift.
std::vector<View> transformed(const std::vector<View>& views, double scale,
                              const Eigen::Vector3d& shift);

}  // namespace sketchsplat
