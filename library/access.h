// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "sketches/graph/sketch.h"
#include "sketches/graph/solid.h"
#include "sketches/io/length_unit.h"
#include "sketchsplat/curves.h"

namespace sketchsplat {

struct CurveSketch::Inside {
  Sketch sketch;
};

struct CurveSolid::Inside {
  Solid solid;
};

/// Throws std::invalid_argument.
LengthUnit unit_of(const std::string& name);
std::string ending_of(const std::string& path);  ///< ".step", in small letters

/// Between the sketch of the method and that of the public headers.
struct CurveSketchAccess {
  static CurveSketch make(Sketch sketch);
  /// Nothing, and why in `why`, if it is not valid or nobody can check it.
  static std::optional<CurveSolid> make(const Solid& solid, std::string* why);
  static const Sketch& sketch(const CurveSketch& curves);
};

}  // namespace sketchsplat
