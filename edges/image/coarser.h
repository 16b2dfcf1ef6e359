// SPDX-License-Identifier: MIT
#pragma once

#include "edges/image/detect.h"

namespace sketchsplat {

/// Adds to the edgels of a picture those of a coarser scale where finer ones show none: the finest
/// scale at which an edge exceeds the noise says where it lies (Elder, Zucker: Local scale control
/// for edge detection and blur estimation, PAMI 1998). They become as wide and as strong as they
/// would be at the finest scale, and lie where it would show them: smoothing pulls an edge that
/// bends towards its centre. Chains that are much wider than those of the finer scales are shading,
/// which was no edge there, and are left out. `sigma_px`, `finest_px`: of the Gaussians of both
/// scales, the former the larger. Runs of fewer than `min_chain` edgels are left out. The look-up
/// of `map` has to be built anew.
void add_coarser(EdgelMap coarse, double sigma_px, double finest_px, int min_chain, EdgelMap* map);

}  // namespace sketchsplat
