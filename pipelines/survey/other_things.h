// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "edges/views/lift.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// Which strokes are of things beside an object on a table (1, else 0); none without a table. What
/// touches, seen from above, is one piece; the object is the piece that has most strokes where the
/// cameras look, all that stands within its outline, and what is too large for a thing beside it,
/// as far as that goes on. Its region (find_object.h) is wider, for strokes fall apart less than
/// single points. Where all that is less than three fifths of the strokes, nothing is told.
std::vector<char> of_other_things(const Sketch& sketch, const EdgeWorld& world);

}  // namespace sketchsplat
