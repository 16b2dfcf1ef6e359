// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sketches/sketch.h"

namespace sketchsplat {

struct SegmentOptions {
  double tolerance = 0.6;    ///< times `unit`: 9 in 10 points of a piece lie this near to its curve
  double corner_deg = 25.0;  ///< [deg] turn from point to point that ends a piece
  int min_points = 3;        ///< shorter pieces are dropped
  double min_length = 4.0;   ///< times `unit`: so are these
};

/// Cuts an ordered run of points with tangents into the simplest curves that explain it: first at
/// corners, then a piece is a line if a line fits, else a circular arc or circle, else a cubic,
/// else it is split where two pieces fit best. Strokes are appended to `sketch`, with nodes of
/// their own. `unit` is the length that tolerances are measured in (one pixel at the object), world
/// units.
void segment_chain(const Eigen::Matrix3Xd& points, const Eigen::Matrix3Xd& tangents, bool closed,
                   double unit, const SegmentOptions& options, Sketch* sketch);

}  // namespace sketchsplat
