// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sketches/graph/solid.h"

namespace sketchsplat {

/// Some faces (one flag each) with their surfaces and the strokes that bound them, which may bound
/// one alone.
Solid keep_faces(const Solid& solid, const std::vector<bool>& keep);

}  // namespace sketchsplat
