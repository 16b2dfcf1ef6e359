// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "datasets/types/image.h"

namespace sketchsplat {

/// What of pictures of one object is the object, told by colours from what is around it: a cut
/// through little contrast is dear, and object and surroundings have colours of their own (as in
/// GrabCut; Rother, Kolmogorov, Blake, SIGGRAPH 2004), half of what all pictures tell, since a face
/// that one picture takes for the table others do not, and half of its own. `maybe`, one per
/// picture, of its size: 1 where the object may be, 2 where that is likely, 0 where it is not; an
/// empty one leaves its picture out. The first colours are those of what is likely; without any, of
/// all that may be. `rounds`: of colours and cuts. The results, of the same sizes, are 1 on the
/// object; empty if the object may be nowhere in the picture, or everywhere. Alpha does not count.
std::vector<Image<uint8_t>> cut_out(const std::vector<const Picture*>& pictures,
                                    const std::vector<Image<uint8_t>>& maybe, int rounds);

}  // namespace sketchsplat
