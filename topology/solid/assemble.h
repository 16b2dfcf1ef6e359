// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "sketches/graph/solid.h"
#include "topology/solid/cells.h"
#include "topology/solid/choose.h"
#include "topology/solid/complete.h"

namespace sketchsplat {

/// The boundary that a choice of cells forms, over all surfaces and strokes (see keep_faces): cells
/// that touch on one surface become one face, its loops run counter-clockwise seen from outside.
/// False, with a clause that says why, if the faces cannot be turned so that each edge is run once
/// in either direction, or if nothing is chosen.
bool assemble(const Completed& all, const std::vector<Cell>& cells, const ChosenCells& chosen,
              Solid* solid, std::string* why);

}  // namespace sketchsplat
