// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sketches/graph/solid.h"

namespace sketchsplat {

/// Some faces (one flag each) with their surfaces and the strokes that bound them, which may bound
/// one alone. `edge_of`: per stroke its index in the edges that are kept, -1 if it is none.
Solid keep_faces(const Solid& solid, const std::vector<bool>& keep,
                 std::vector<int>* edge_of = nullptr);

}  // namespace sketchsplat
