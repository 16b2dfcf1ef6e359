// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "datasets/synthetic/render/painter.h"
#include "datasets/types/image.h"

namespace sketchsplat {

struct RenderOptions {
  Style style = Style::kPlain;
  double texture_strength = 1;  ///< contrast of what Style::kTextured and kSpeckled print, [0, 1]
  double even_light = 0;  ///< share of the light that comes evenly from all sides, see Look, [0, 1]
  bool clutter = false;         ///< things far behind the object; the picture is opaque then
  double noise = 0;  ///< standard deviation of the noise [grey levels], [0, 100]; where alpha > 0
  double blur = 0;   ///< Gaussian blur [px], [0, 20]
  double exposure = 0;  ///< standard deviation of the exposure of views [stops], [0, 2]
  int jpeg = 0;  ///< quality of a compression that the picture went through, [0, 100]; 0: none, of
                 ///< photographs 92
  bool transparent = true;  ///< alpha is the coverage; else the picture is opaque
  double background = 1.0;  ///< grey of an opaque background, [0, 1]
};

/// What a camera makes of a painting: blur, exposure, sRGB, noise, compression. Colour is not
/// premultiplied. Noise is the same for the three colours; it depends on (seed, index, pixel)
/// alone, and a larger one is the same noise, scaled. Compression sees a transparent picture over
/// its background; alpha stays as it is.
Picture expose(const Painting& painting, const RenderOptions& options, std::uint64_t seed,
               int index);

/// The same of a photograph's colours, linear light before and in [0, 1] after, in place. Noise is
/// of each colour its own; nothing is compressed; alpha, if any, stays as it is.
void expose_photo(const RenderOptions& options, std::uint64_t seed, int index, Picture* picture);

/// How much more light than on average a view gets.
double exposure_of(const RenderOptions& options, std::uint64_t seed, int index);

}  // namespace sketchsplat
