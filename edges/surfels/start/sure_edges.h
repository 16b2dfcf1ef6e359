// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "edges/views/lift.h"
#include "edges/views/match.h"

namespace sketchsplat {

/// A line of sight that nothing blocks: from a camera to an edge that its picture shows.
struct SightLine {
  Eigen::Vector3d eye, point;  ///< world units
};

/// Edges, printed ones too, that are where they seem to be, and who sees them.
struct SureEdges {
  Eigen::Matrix3Xd position;     ///< world units
  Eigen::Matrix3Xd tangent;      ///< unit, as many
  std::vector<SightLine> lines;  ///< to these points and between them
  double footprint = 0;          ///< world length of one pixel at the object
};

struct SureEdgeOptions {
  int run = 5;           ///< points of a track in a row that a view must see
  int views = 5;         ///< that must see a point
  double claim = 0.7;    ///< least part of the views that see another point at the same edgel
  int beside = 8;        ///< [edgels] along the chain to either side that a sighting lays claim to
  double apart_px = 10;  ///< [pixel footprints] between the depths of points of which an edgel may
                         ///< be either
  int fan = 3;           ///< lines per step from point to point
};

/// Of the points of tracks those that are seen where no better seen point claims the edgel: points
/// where rays cross by accident borrow the edgels of others. And the lines of sight to them, but
/// for those where an edgel may be of either of two points: there one is hidden by the other.
SureEdges sure_edges(const EdgeWorld& world, const CurvePoints& tracks,
                     const SureEdgeOptions& options = {});

}  // namespace sketchsplat
