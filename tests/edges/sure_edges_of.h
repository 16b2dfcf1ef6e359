// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "edges/surfels/start/sure_edges.h"
#include "tests/support/wireframe.h"

namespace sketchsplat::test {

/// Points along straight edges, `spacing` apart, and lines of sight to them from all of `eyes`.
inline SureEdges sure_edges_of(const std::vector<Polyline>& edges, double spacing,
                               const std::vector<Eigen::Vector3d>& eyes) {
  SureEdges out;
  out.footprint = spacing / 4;
  std::vector<Eigen::Vector3d> positions, tangents;
  for (const Polyline& e : edges) {
    const int n = std::max(1, int((e[1] - e[0]).norm() / spacing));
    for (int k = 0; k < n; ++k) {
      positions.push_back(e[0] + (k + 0.5) / n * (e[1] - e[0]));
      tangents.push_back((e[1] - e[0]).normalized());
      for (const Eigen::Vector3d& eye : eyes) out.lines.push_back({eye, positions.back()});
    }
  }
  out.position.resize(3, positions.size()), out.tangent.resize(3, positions.size());
  for (size_t i = 0; i < positions.size(); ++i) {
    out.position.col(i) = positions[i];
    out.tangent.col(i) = tangents[i];
  }
  return out;
}

/// The twelve edges of a box.
inline std::vector<Polyline> box_edges(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  std::vector<Polyline> out = cube_edges(Eigen::Vector3d::Zero(), 1);
  for (Polyline& e : out)
    for (Eigen::Vector3d& p : e) p = low + p.cwiseProduct(high - low);
  return out;
}

}  // namespace sketchsplat::test
