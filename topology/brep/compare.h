// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "sketches/graph/solid_comparison.h"

namespace sketchsplat {

/// Compares two STEP files that hold solids, the second of which is the truth. Throws InputError.
SolidComparison compare_solids(const std::string& path, const std::string& true_path);

}  // namespace sketchsplat
