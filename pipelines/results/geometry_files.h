// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "datasets/types/geometry_maps.h"
#include "datasets/types/view.h"

namespace sketchsplat {

/// Makes `out`/depth, normal and alpha. Throws OutputError.
void prepare_geometry_folders(const std::string& out);

/// Writes the maps of a view, named as its image: depth/<name>.exr (Z) and normal/<name>.exr
/// (camera frame) as read_geometry_maps reads them, and beside each, and in alpha/, a PNG to look
/// at: near is bright; normals as estimators colour them (OpenGL's frame); alpha. Throws
/// OutputError.
void write_geometry_maps(const std::string& out, const View& view, const GeometryMaps& maps);

}  // namespace sketchsplat
