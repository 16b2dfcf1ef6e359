// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "datasets/types/image.h"

namespace sketchsplat {

/// What of a picture is the object, told by colours from what is around it: a cut through little
/// contrast is dear, and object and surroundings have a mixture of colours each (GrabCut; Rother,
/// Kolmogorov, Blake, SIGGRAPH 2004). `maybe`: 1 where the object may be, 2 where that is likely, 0
/// where it is not; of the picture's size. The first colours are those of what is likely; without
/// any, of all that may be. `rounds`: of colours and cuts. The result, of the same size, is 1 on
/// the object; empty if the object may be nowhere, or everywhere. Alpha does not count. Equal input
/// gives equal output.
Image<uint8_t> cut_out(const Picture& picture, const Image<uint8_t>& maybe, int rounds);

}  // namespace sketchsplat
