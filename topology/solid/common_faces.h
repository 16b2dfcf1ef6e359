// SPDX-License-Identifier: MIT
#pragma once

#include "sketches/graph/solid.h"

namespace sketchsplat {

/// The faces of one solid that another has, too: on the same surface, between the same curves, with
/// the material on the same side. Of two choices from one sketch, before they are adjusted: numbers
/// are compared exactly. Only strokes that bound such a face are kept; they may bound one alone.
Solid common_faces(const Solid& one, const Solid& other);

}  // namespace sketchsplat
