// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>

#include "datasets/types/camera.h"
#include "datasets/types/image.h"

namespace sketchsplat {

/// Reads a normal map as estimators (StableNormal, ...) write it: an RGB image whose channels
/// [0, 1] (8 bits: [0, 255]) are the components [-1, 1] in the camera frame of OpenGL: x right, y
/// up, z towards the viewer, so that a wall that faces the camera is (0.5, 0.5, 1). Returns unit
/// normals in the frame of this program: x right, y down, z forward. Pixels whose vector is no
/// longer than 0.5 or longer than 1.5 (black), or that are transparent, hold none: zero. Throws
/// InputError if the file is no colour image of the camera's size, or if most normals face away
/// from the camera: another frame.
std::array<Image<float>, 3> read_normal_map(const std::string& path, const Camera& camera);

}  // namespace sketchsplat
