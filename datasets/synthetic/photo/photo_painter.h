// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "datasets/synthetic/cad/truth.h"
#include "datasets/synthetic/photo/photo_light.h"
#include "datasets/types/image.h"
#include "datasets/types/view.h"

namespace sketchsplat {

/// A photograph before the camera's electronics: linear light in red, green and blue, and in alpha
/// the part's share of each pixel.
///
/// Every pixel is looked at through the view's lens, so that nothing is ever resampled: one ray
/// where nothing changes, up to 4 x 4 where prints do, 6 x 6 where surfaces do and along `edges`
/// (thin things hide there); filtered as in paint(). Light is computed where it changes and
/// interpolated elsewhere. Tiles are painted in parallel (OpenMP); memory is that of the picture.
Picture paint_photo(const PhotoWorld& world, const PhotoShader& shader,
                    const std::vector<TruthCurve>& edges, const View& view, std::uint64_t seed,
                    int index);

}  // namespace sketchsplat
