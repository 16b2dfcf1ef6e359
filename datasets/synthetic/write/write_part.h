// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "datasets/synthetic/cad/brep.h"

namespace sketchsplat {

/// The part in world units, as millimetres, as STEP: its box, of longest side `extent`, is centred
/// at (0.5, 0.5, 0.5) extents. Throws OutputError.
void write_part(const Brep& brep, const UnitFrame& frame, double extent, const std::string& path);

}  // namespace sketchsplat
