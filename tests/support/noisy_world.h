// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <vector>

#include "edges/views/lift.h"
#include "tests/support/strokes.h"

namespace sketchsplat::test {

using Eigen::Vector3d;
inline const Vector3d kMiddle(0.5, 0.5, 0.5);

/// Edgels that scatter, and views that are wrong about a whole curve, too.
inline EdgeWorld noisy_world(const Sketch& truth, int views, unsigned seed, double unit = 1,
                             int side = 400) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const std::vector<View> ring = ring_of_views(views, unit * kMiddle, 3 * unit, side);
  std::vector<EdgelMap> maps;
  for (const View& view : ring) {
    EdgelMap map = ideal_edgels(view, polylines_of(truth));
    for (size_t c = 0; c + 1 < map.chain.size(); ++c) {
      const double aside = 0.1 * normal(random);
      for (int i = map.chain[c]; i < map.chain[c + 1]; ++i) {
        Edgel& e = map.edgels[i];
        const double d = aside + 0.2 * normal(random);
        e.x += float(d * e.nx), e.y += float(d * e.ny);
      }
    }
    build_lookup(&map, 4.0);
    maps.push_back(map);
  }
  return make_edge_world(ring, maps);
}

/// A box about the middle, turned; its upper face rises by `ramp_deg` along the first edge.
inline Sketch box(double ramp_deg = 0) {
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(0.4, Vector3d(1, 2, 3).normalized()) *
                                Eigen::AngleAxisd(0.7, Vector3d::UnitX()))
                                   .toRotationMatrix();
  const Vector3d size(0.8, 0.6, 0.4);
  Sketch s;
  for (int k = 0; k < 8; ++k) {
    Vector3d p((k & 1) - 0.5, (k >> 1 & 1) - 0.5, (k >> 2) - 0.5);
    p = p.cwiseProduct(size);
    if (k >> 2) p.z() += std::tan(ramp_deg * M_PI / 180) * p.x();
    s.add_node(kMiddle + turn * p);
  }
  for (int axis = 0; axis < 3; ++axis)
    for (int k = 0; k < 8; ++k)
      if (!(k >> axis & 1)) s.add_stroke(StrokeKind::kLine, k, k | 1 << axis, {});
  return s;
}

}  // namespace sketchsplat::test
