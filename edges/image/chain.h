// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "edges/image/detect.h"

namespace sketchsplat {

/// Edgels of one image before they are chained: at most one per pixel.
struct Candidates {
  std::vector<Edgel> edgels;
  Image<int> at;  ///< index of the edgel that belongs to a pixel, or -1
};

/// Hysteresis along curves: every candidate points at its best continuation on either side, mutual
/// or not; runs are followed from candidates of at least `high` strength, and kept from `min_chain`
/// edgels on. `signed_normals`: normals of one edge point to one side (gradients do, ridges do
/// not).
void chain_edgels(const Candidates& candidates, float high, int min_chain, bool signed_normals,
                  EdgelMap* map);

}  // namespace sketchsplat
