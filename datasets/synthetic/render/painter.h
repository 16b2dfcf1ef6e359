// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "datasets/synthetic/render/clutter.h"
#include "datasets/synthetic/render/shading.h"
#include "datasets/synthetic/render/tracer.h"
#include "datasets/types/image.h"
#include "datasets/types/view.h"

namespace sketchsplat {

/// What there is to paint; unit frame.
struct Subject {
  const Tracer& object;
  const Shader& shader;
  const Clutter* clutter;         ///< null: nothing stands behind the object
  const Eigen::Matrix3Xd& hints;  ///< 3 x N  points along edges of the object, at most a pixel or
                                  ///< two apart, where features thinner than a pixel may hide
};

/// A view before the camera's electronics: one value per pixel.
struct Painting {
  Image<float> light;  ///< linear; times the coverage, unless there is clutter behind
  Image<float> alpha;  ///< coverage by the object, in [0, 1]
  /// Of the object at the middle of the pixel; 0 where the ray through it meets nothing.
  Image<float> depth;                         ///< along the camera's axis, unit lengths
  Image<float> normal_x, normal_y, normal_z;  ///< unit, camera axes, towards the camera
};

/// One ray per pixel, six by six where something changes, filtered as Blender does
/// (Blackman-Harris over 3 px). `view` is in the unit frame; rays are spread by (seed, index).
Painting paint(const Subject& subject, const View& view, std::uint64_t seed, int index);

}  // namespace sketchsplat
