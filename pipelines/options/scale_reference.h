// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "sketches/io/length_unit.h"

namespace sketchsplat {

/// What somebody has measured: the argument of --scale-by.
struct ScaleReference {
  enum class Kind {
    kTag,       ///< edge of the black square of the AprilTags, or of the one with the id `first`
    kSize,      ///< longest side of the box around all curves
    kDiameter,  ///< of the largest full circle
    kCircle,    ///< diameter of the circle or arc `first`
    kLine,      ///< length of the line `first`
    kNodes,     ///< distance of the nodes `first` and `second`
  };
  Kind kind = Kind::kSize;
  int first = -1, second = -1;     ///< as sketch.json counts
  double length = 0;               ///< > 0
  std::optional<LengthUnit> unit;  ///< of the length; if nobody says, that of the files
};

/// "tag=10", "tag:3=10mm", "size=80", "diameter=25.4", "circle:12=1in", "line:3=80",
/// "nodes:3-7=80". Throws UsageError.
ScaleReference parse_scale_reference(const std::string& text);

}  // namespace sketchsplat
