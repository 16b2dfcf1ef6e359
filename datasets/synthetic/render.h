// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "datasets/image.h"
#include "datasets/synthetic/tracer.h"
#include "datasets/view.h"

namespace sketchsplat {

struct RenderOptions {
  double noise = 0;  ///< standard deviation of the noise [grey levels], [0, 100]; where alpha > 0
  double blur = 0;   ///< Gaussian blur [px], [0, 20]
  double exposure = 0;      ///< standard deviation of the exposure of views [stops], [0, 2]
  bool transparent = true;  ///< alpha is the coverage; else the picture is opaque
  double background = 1.0;  ///< grey of an opaque background, [0, 1]
};

/// A picture of the mesh behind `tracer`: grey object under five lamps and a sky that stand still
/// in the unit frame; linear light, filtered as Blender does (Blackman-Harris over 3 px), then
/// sRGB; colour not premultiplied. Six by six rays per pixel where something changes, one
/// elsewhere. `view` is in the unit frame. `hints`: 3 x N points along edges of the object, at most
/// a pixel or two apart, where features thinner than a pixel may hide from the one ray. Noise is
/// the same for the three colours; it depends on (seed, index, pixel) alone.
Picture render(const Tracer& tracer, const View& view, const Eigen::Matrix3Xd& hints,
               const RenderOptions& options, std::uint64_t seed, int index);

}  // namespace sketchsplat
