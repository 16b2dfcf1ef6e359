// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

namespace sketchsplat {

/// Triangles of a mesh file, in its units. Corners are indices into points.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<int, 3>> triangles;  ///< of three different points each
};

/// The file's ending says that it is a mesh: .obj, .stl, .ply or .off, in any case.
bool is_mesh_file(const std::string& path);

/// Polygons are cut into triangles by their ears; points nearer than 1e-6 of the longest side of
/// the bounding box are one (STL repeats every corner). Throws InputError if the file is missing,
/// cannot be read, or holds no face or a coordinate that is not finite.
TriangleMesh read_mesh(const std::string& path);

}  // namespace sketchsplat
