// SPDX-License-Identifier: MIT
#pragma once

#include "edges/image/detect.h"

namespace sketchsplat {

struct MapOptions {
  double sigma_px = 1.2;  ///< [px] smoothing before the ridge is looked for
  double high = 0.35;  ///< share of the map's strong ridges (99th percentile) where an edge starts
  double low = 0.12;   ///< and down to which it is followed
  int min_chain = 6;   ///< [px] shorter chains are dropped
};

/// Edgels from somebody's edge map (DexiNed, PiDiNet, ...): values in [0, 1], thick edges, white on
/// black or black on white (edges are the minority). Localised on the ridge: the maximum across the
/// direction of the strongest negative curvature of the smoothed map (Steger, PAMI 1998). Normals
/// of ridges have no bright side: their sign means nothing. An empty or flat map gives no edgels.
EdgelMap detect_ridges(const Image<float>& map, const MapOptions& options);

}  // namespace sketchsplat
