// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "datasets/synthetic/render/tracer.h"

namespace sketchsplat {

/// Things behind the object: a room around all cameras, and boxes and pyramids of several sizes
/// between its walls and the cameras. They stand still, and never in front of the object.
struct Clutter {
  Tracer tracer;  ///< unit frame; every flat side is a face of its own
  float size;     ///< how much larger than the object they are
};

/// `reach`: distance of the furthest camera from the origin of the unit frame, > 1.
Clutter make_clutter(double reach, std::uint64_t seed);

}  // namespace sketchsplat
