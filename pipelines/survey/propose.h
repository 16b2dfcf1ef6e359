// SPDX-License-Identifier: MIT
#pragma once

#include "edges/views/lift.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

struct ProposeOptions {
  double tolerance = 0.02;  ///< of an edge's length: misfit of a parallelogram's fourth corner
};

/// Lines that the graph implies and that no view can show, with their own nodes: where two lines
/// are three sides of a parallelogram or more, whose open corners lack an edge.
///   - a - b - c - d, with d - a parallel to b - c: the side d - a.
///   - a - b - c and a - b' - c', completed to parallelograms, whose fourth corners agree: that
///     corner and the sides that lead to it; it is a corner that no view sees.
/// Only between nodes of exactly two lines, which is no corner of a solid, and only where the
/// visual hull hides all of it from all views: without masks nothing is proposed. Faces that are
/// no parallelograms are not completed. The evidence holds the confidence alone, at most 0.3.
Sketch propose_edges(const Sketch& sketch, const EdgeWorld& world,
                     const ProposeOptions& options = {});

}  // namespace sketchsplat
