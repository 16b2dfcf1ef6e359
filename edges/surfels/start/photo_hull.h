// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "edges/surfels/model/training_view.h"
#include "edges/surfels/start/sure_edges.h"

namespace sketchsplat {

struct PhotoHullOptions {
  int cells = 96;           ///< along the longest side of the bounds
  int sweeps = 60;          ///< of carving, at the most; 0 leaves the visual hull
  double tolerance = 0.02;  ///< grey values in [0, 1] by which views may differ
  double sights = 0.25;     ///< share of the cells between planes that lines of sight must cross to
                            ///< empty them; 0: lines are not looked at
  double agree = 0.75;      ///< share of the views that must be able to see one grey
  int seed = 0;             ///< of the planes and the points that are drawn
};

/// Points on a closed surface.
struct SurfaceSamples {
  Eigen::Matrix3Xd position;
  Eigen::Matrix3Xd normal;  ///< unit, outwards
  double spacing = 0;       ///< least distance of two points, world units
  double cell = 0;          ///< of the grid that they were taken from, world units
  int planes = 0;           ///< of the edges, between which lines of sight emptied the hull
  int emptied = 0;          ///< cells that lines of sight took away
  int carved = 0;           ///< cells that were taken away because the views disagree
};

/// About `count` points spread over the surface of the photo hull: the cells that every mask holds
/// (Laurentini, PAMI 1994) less what lines of sight to `sure` edges leave empty between the planes
/// of these edges (PlaneCarving) and cells that many of them cross, less those where the views that
/// see them do not agree on a grey (Kutulakos and Seitz, A theory of shape by space carving, IJCV
/// 2000). A view's say is the range of greys within the cell's footprint, so that cells on edges
/// stay. Carving counts for nothing where it leaves pixels of masks without a cell (surfaces that
/// shine do not agree on greys). Empty if nothing is left. The same for any number of threads.
SurfaceSamples photo_hull_surface(const std::vector<TrainingView>& views,
                                  const Eigen::AlignedBox3d& bounds, int count,
                                  const PhotoHullOptions& options, const SureEdges& sure = {});

}  // namespace sketchsplat
