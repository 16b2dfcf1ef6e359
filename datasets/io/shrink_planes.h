// SPDX-License-Identifier: MIT
#pragma once

#include "datasets/io/image_planes.h"

namespace sketchsplat {

/// Averages blocks of `denominator` x `denominator` pixels; colours are weighed by alpha if there
/// is one. The last block of a row or column may be smaller: sizes are rounded up. 1 changes
/// nothing.
void shrink_planes(int denominator, Planes* planes);

}  // namespace sketchsplat
