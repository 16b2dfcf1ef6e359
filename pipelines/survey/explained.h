// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "edges/views/lift.h"
#include "edges/views/match.h"
#include "edges/views/unexplained.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// Places along the strokes, a curve for each, at most `spacing` [world units] apart.
CurvePoints points_on(const Sketch& sketch, double spacing);

/// Flags the edgels along the strokes in every view, be they seen there or not (explain()).
EdgelFlags edgels_along(const Sketch& sketch, const EdgeWorld& world);

/// How much of the images strokes explain.
struct Explained {
  std::vector<double> edgels;   ///< per view: share of its edgels that lie on images of strokes
  std::vector<double> samples;  ///< per view: share of what it shows of the strokes that has edgels
  double share = 0;             ///< of all edgels
};

/// Edgels within `reach_px` of a stroke's image, along it, are explained; once, even if several
/// strokes lie there, as they do where cameras err. Zero throughout for a sketch without strokes.
Explained explained(const Sketch& sketch, const EdgeWorld& world, double reach_px = 2);

/// Views of which strokes explain far less than of the usual one, in both ways: 1, else 0.
std::vector<char> unfit_views(const Explained& shares);

}  // namespace sketchsplat
