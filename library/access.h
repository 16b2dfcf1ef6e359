// SPDX-License-Identifier: MIT
#pragma once

#include "sketches/graph/sketch.h"
#include "sketchsplat/curves.h"

namespace sketchsplat {

struct CurveSketch::Inside {
  Sketch sketch;
};

/// Between the sketch of the method and that of the public headers.
struct CurveSketchAccess {
  static CurveSketch make(Sketch sketch);
  static const Sketch& sketch(const CurveSketch& curves);
};

}  // namespace sketchsplat
