// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "topology/solid/find_solid.h"

namespace sketchsplat {

/// The edges of a solid as a sketch.
struct SharpEdges {
  Sketch sketch;
  std::vector<bool> inferred;  ///< per stroke: no image shows it, the faces imply it
  std::vector<int> now;        ///< per stroke that was given: its index in `sketch`, or -1
  bool bent = false;           ///< cubics along one edge were bent to go on from one another
};

/// Of a search that found a solid: its edges, as they were seen, but those along which faces touch,
/// which are none to the eye. `with_inferred`: those that no image shows, too.
SharpEdges sharp_edges(const SolidSearch& found, bool with_inferred);

/// Of a search that found faces which are sure, but no solid: the sketch as it is, with the edges
/// between two of these faces that no image shows. Their ends share the nodes within `reach`.
SharpEdges with_sure_edges(const Sketch& sketch, const SolidSearch& found, double reach);

}  // namespace sketchsplat
