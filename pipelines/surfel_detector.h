// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "pipelines/detectors.h"

namespace sketchsplat {

/// The detector "2dgs-sn": surfels are fitted to all pictures (edges/surfel_field.h), edges are
/// those of the depth and normals that the surfels show in a view and of its alpha. With `snap`,
/// an edge of the picture beside an edge of the geometry says where that is.
std::unique_ptr<Detector> make_surfel_detector(const DetectionOptions& options);

/// Edgels of the picture that run along an edgel of the geometry within `reach_px`, and those of
/// the geometry that no such edgel is near to.
EdgelMap snap_edgels(const EdgelMap& geometry, const EdgelMap& picture, double reach_px);

}  // namespace sketchsplat
