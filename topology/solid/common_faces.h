// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sketches/graph/solid.h"

namespace sketchsplat {

/// The faces of one solid that another has, too: on the same surface, between the same curves, with
/// the material on the same side. Of two choices from one sketch, before they are adjusted: numbers
/// are compared exactly.
Solid common_faces(const Solid& one, const Solid& other);

/// Some faces (one flag each) with their surfaces and the strokes that bound them, which may bound
/// one alone.
Solid keep_faces(const Solid& solid, const std::vector<bool>& keep);

}  // namespace sketchsplat
