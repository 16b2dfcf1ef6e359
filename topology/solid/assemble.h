// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sketches/graph/solid.h"
#include "topology/solid/cells.h"
#include "topology/solid/choose.h"
#include "topology/solid/find_surfaces.h"

namespace sketchsplat {

/// The boundary that a choice of cells forms: cells that touch on one surface become one face, its
/// loops run counter-clockwise seen from outside, and only strokes that bound faces are kept.
/// `inferred`: per stroke of the sketch. False, with a clause that says why, if the faces cannot be
/// turned so that each edge is run once in either direction, or if nothing is chosen.
bool assemble(const Sketch& sketch, const std::vector<bool>& inferred,
              const std::vector<Eigen::Matrix3Xd>& polylines,
              const std::vector<SurfaceStrokes>& surfaces, const std::vector<Cell>& cells,
              const ChosenCells& chosen, Solid* solid, std::string* why);

}  // namespace sketchsplat
