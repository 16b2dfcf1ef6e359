// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "edges/depth/edgel_support.h"
#include "edges/views/link.h"
#include "edges/views/match.h"

namespace sketchsplat {

/// Points that continue one another in space: curve c of the result is a track. Lone points and
/// tracks of fewer than `min_points` are left out.
CurvePoints track_points(const std::vector<EdgePoint>& points, double footprint, int min_points);

/// What an edgel, or a point of a track, is.
enum class EdgeKind : std::uint8_t {
  kUnknown,
  kShape,  ///< an edge of the shape
  kPrint,  ///< on a smooth surface
};

/// The edgels of one view that show some points of the tracks.
struct TrackSightings {
  std::vector<int> point;         ///< index in the tracks
  std::vector<EdgelPlace> place;  ///< as long
};

/// Where the tracks are seen, view by view: of every `every`-th point, for neighbours say the same.
std::vector<TrackSightings> track_sightings(const EdgeWorld& world, const CurvePoints& tracks,
                                            int every);

/// Every point is what the views that see it, and its neighbours along the track, say: on an edge
/// of the shape if half of the views have one there, print if three quarters have none (quantiles:
/// a view in which another surface is near, or a hole in the surfels, does not count). A view in
/// which the point lies farther off the geometry than `reach_px` [pixel footprints] has no say:
/// something hides it, or the geometry is wrong. Unknown if none has. `support`: per view, as long
/// as the sightings.
std::vector<EdgeKind> judge_tracks(const CurvePoints& tracks,
                                   const std::vector<TrackSightings>& sightings,
                                   const std::vector<std::vector<EdgelSupport>>& support,
                                   double reach_px);

/// Of every view and edgel: what the nearest sighting along its chain is of, up to `along` edgels
/// away, among those that lie on the geometry as above.
std::vector<std::vector<EdgeKind>> edgel_kinds(
    const EdgeWorld& world, const std::vector<TrackSightings>& sightings,
    const std::vector<std::vector<EdgelSupport>>& support, const std::vector<EdgeKind>& kinds,
    double reach_px, int along);

}  // namespace sketchsplat
