// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "tests/support/wireframe.h"

namespace sketchsplat::test {

/// A block and a bar in it: what it shows fixes a camera.
inline std::vector<Polyline> house() {
  std::vector<Polyline> out = cube_edges({0.2, 0.2, 0.2}, 0.6);
  for (const Polyline& p : cube_edges({0.35, 0.42, 0.3}, 0.25)) out.push_back(p);
  return out;
}
inline const Eigen::Vector3d kHouseMiddle(0.5, 0.5, 0.5);

/// What the views show of it, exactly.
inline std::vector<EdgelMap> house_edgels(const std::vector<View>& views) {
  std::vector<EdgelMap> maps;
  for (const View& v : views) maps.push_back(ideal_edgels(v, house()));
  return maps;
}

}  // namespace sketchsplat::test
