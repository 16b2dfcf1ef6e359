// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "edges/surfels/start/edge_tracks.h"
#include "pipelines/detectors/detectors.h"

namespace sketchsplat {

/// The detector "2dgs-sn": surfels are fitted to all pictures (edges/surfels/fit/surfel_field.h),
/// edges are those of the depth and normals that the surfels show in a view and of its alpha. An
/// edge of the picture beside an edge of the geometry says where that is, and edges of the pictures
/// that continue one another in space are judged by the surfels of all views
/// (edges/surfels/start/edge_tracks.h).
std::unique_ptr<Detector> make_surfel_detector(const DetectionOptions& options);

/// Edgels of the picture that lie on edges of the shape: those that are known to (`kinds`, one per
/// edgel of the picture, or none), and of the unknown ones those that run along an edgel of the
/// geometry within `reach_px`, or all if the colours are `even`, so that little can be print. And
/// those of the geometry, which has a look-up, that no such edgel is near to.
EdgelMap snap_edgels(const EdgelMap& geometry, const EdgelMap& picture,
                     const std::vector<EdgeKind>& kinds, bool even, double reach_px);

}  // namespace sketchsplat
