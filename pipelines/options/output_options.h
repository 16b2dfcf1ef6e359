// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "pipelines/base/fields.h"
#include "sketches/io/length_unit.h"

namespace sketchsplat {

/// What files for CAD programs say beside the curves.
struct CadOptions {
  LengthUnit unit = LengthUnit::kMillimetre;  ///< of the numbers in the file
  double scale = 1.0;                         ///< units per world unit
  std::string scale_by = "none";              ///< what tells the scale instead, see known_scale.h
  bool unit_given = false, scale_given = false;  ///< by the user
  bool faces = false;                            ///< closed planar loops as faces, in STEP
};

/// What is written beside the sketch, and how.
struct OutputOptions {
  int overlays = 4;           ///< views that are drawn over
  bool reproducible = false;  ///< no times, memory and threads in the reports
  CadOptions cad;             ///< of sketch.step
};

/// As in options.h.
void list_fields(CadOptions* options, Fields* fields);
void list_fields(OutputOptions* options, Fields* fields);

}  // namespace sketchsplat
