// SPDX-License-Identifier: MIT
#pragma once

#include "sketches/graph/solid.h"

namespace sketchsplat {

/// Moves surfaces, nodes and handles as little as it takes until every stroke lies on the surfaces
/// of both faces that it bounds; surfaces that are parallel or square to one another within a
/// quarter of a degree become so. Sets Solid::gap.
void adjust(Solid* solid);

}  // namespace sketchsplat
