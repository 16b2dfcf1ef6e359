// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace sketchsplat {

/// The vertices of a PLY file.
struct PlyPoints {
  Eigen::Matrix3Xd position;  ///< 3 x N
  std::vector<int> stroke;    ///< N, or empty: the property `stroke_index` (or one called so)
};

/// Reads the vertices of an ASCII or binary little-endian PLY; other elements are not looked at.
/// A scalar property whose name holds "stroke" or "index", or is "id", becomes `stroke`.
/// Throws InputError: no such file, no PLY, big endian, no x, y, z, truncated, a number not finite.
PlyPoints read_ply_points(const std::string& path);

}  // namespace sketchsplat
