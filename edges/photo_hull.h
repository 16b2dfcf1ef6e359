// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "edges/sight_lines.h"
#include "edges/training_view.h"

namespace sketchsplat {

struct PhotoHullOptions {
  int cells = 96;           ///< along the longest side of the bounds
  int sweeps = 60;          ///< of carving, at the most; 0 leaves the visual hull
  double tolerance = 0.02;  ///< grey values in [0, 1] by which views may differ
  double sights = 1;        ///< mean number of lines of sight through the cells about a cell that
                            ///< empties it; 0: lines are not looked at
  double agree = 0.75;      ///< share of the views that must be able to see one grey
};

/// Points on a closed surface.
struct SurfaceSamples {
  Eigen::Matrix3Xd position;
  Eigen::Matrix3Xd normal;  ///< unit, outwards
  double spacing = 0;       ///< least distance of two points, world units
  double cell = 0;          ///< of the grid that they were taken from, world units
  int carved = 0;           ///< cells that were taken away because the views disagree
};

/// About `count` points spread over the surface of the photo hull: the cells that every mask holds
/// (Laurentini, PAMI 1994) less those where the views that see them do not agree on a grey
/// (Kutulakos and Seitz, A theory of shape by space carving, IJCV 2000) and those that `sights` go
/// through. A view's say is the range
/// of greys within the cell's footprint, so that cells on edges stay. Where
/// that leaves pixels of masks without a cell (surfaces that shine do not agree on greys), all that
/// was carved counts for nothing. Empty if nothing is left. The
/// same for any number of threads.
SurfaceSamples photo_hull_surface(const std::vector<TrainingView>& views,
                                  const Eigen::AlignedBox3d& bounds, int count,
                                  const PhotoHullOptions& options,
                                  const std::vector<SightLine>& sights = {});

}  // namespace sketchsplat
