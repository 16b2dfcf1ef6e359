// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "datasets/synthetic/scene/synthesize.h"

namespace sketchsplat {

/// Writes photographs as COLMAP leaves them:
///   images/NNN.jpg, masks/NNN.png (the part's share of each pixel) if the options say so,
///   sparse/0/{cameras,images,points3D}.txt: the cameras as stated, and points of surfaces,
///   true/{cameras,images,points3D}.txt: the true ones, where those of sparse/0 err,
///   groundtruth/ as write_scene() does, visible_views of what the photographs show,
///   scene.json, last: the true lens (pixel centres are integers), which way is up, height of the
///     table along it, exposures, RMS of the stated cameras' errors at the part's edges [px] and
///     the corners of the tag, all in world units.
/// One photograph at a time, its tiles in parallel. Throws OutputError.
void write_photos(const SyntheticScene& scene, const std::string& folder);

}  // namespace sketchsplat
