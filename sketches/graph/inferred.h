// SPDX-License-Identifier: MIT
#pragma once

#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// Does something else than the images tell of a stroke: the faces about it, or siblings of the
/// part? Its confidence is known, then, and no view sees it.
inline bool is_inferred(const Evidence& evidence) {
  return evidence.confidence > 0 && evidence.support_views == 0;
}

}  // namespace sketchsplat
