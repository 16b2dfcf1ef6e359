// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core.hpp>

#include "edges/image/detect.h"

namespace sketchsplat {

/// Drops what texture and noise make as well: a-contrario validation of chains (Desolneux, Moisan,
/// Morel: Edge detection by Helmholtz principle, JMIV 2001), by contrast and by smoothness. By
/// contrast: a place on an edge is stronger than the pixels around (their share that is as strong
/// is the chance of it). By smoothness: an edge keeps its curvature from step to step, chains in
/// texture turn at random, but those of hatching, see hatching.h. Of every chain the pieces with
/// the most evidence are kept; `meaning` of the map is filled in. `magnitude`: of the gradient, one
/// value per pixel of what the edgels' coordinates refer to. `outline`, of the same size: not 0 in
/// pixels whose gradient the end of the mask makes, or may make that of the object within it
/// (Picture::beyond_px): no texture to judge other edges by.
void keep_meaningful(const cv::Mat1f& magnitude, const cv::Mat1b& outline,
                     const MeaningOptions& options, EdgelMap* map);

}  // namespace sketchsplat
