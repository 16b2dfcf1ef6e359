// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "datasets/synthetic/cad/brep.h"

namespace sketchsplat {

/// Adds a flat face, a fan about its first corner, and returns its number.
inline int add_flat_face(const std::vector<Eigen::Vector3f>& corners, SurfaceMesh* mesh) {
  const int face = mesh->face.empty() ? 0 : mesh->face.back() + 1;
  const unsigned first = unsigned(mesh->points.size());
  const Eigen::Vector3f normal =
      (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  for (const Eigen::Vector3f& corner : corners) {
    mesh->points.push_back(corner);
    mesh->normals.push_back(normal);
  }
  for (unsigned i = 2; i < corners.size(); ++i) {
    mesh->corners.push_back({first, first + i - 1, first + i});
    mesh->face.push_back(face);
  }
  return face;
}

}  // namespace sketchsplat
