// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "sketches/graph/solid.h"
#include "sketches/io/length_unit.h"

namespace sketchsplat {

/// What a solid is as a boundary representation. World units.
struct SolidCheck {
  bool valid = false;
  std::string why;  ///< a clause if not valid: "edge 3, line: it bounds 1 face, not two"
  double volume = 0, area = 0;
  /// Largest of an edge or a vertex: what lies between curves and the surfaces that they bound.
  double tolerance = 0;
};

struct StepSolidOptions {
  std::string name = "solid";                 ///< of the product, UTF-8
  double scale = 1.0;                         ///< units per world unit, > 0
  LengthUnit unit = LengthUnit::kMillimetre;  ///< of the numbers in the file
};

/// Builds the exact boundary representation of a solid and checks it: closed, of one piece but for
/// voids, valid to OpenCASCADE (curves on their surfaces, loops that do not cross), no faces that
/// run through each other, tolerances below 1e-4 of the extent. A solid whose faces all look
/// inwards is turned. Only if it is valid, `path` gets an AP214 file with one MANIFOLD_SOLID_BREP
/// (BREP_WITH_VOIDS), its faces named by index and coloured by their surfaces, whole or not at all;
/// the same bytes for the same solid. An empty path: nothing is written. Throws OutputError if the
/// file cannot be written.
SolidCheck write_solid_step(const Solid& solid, const std::string& path,
                            const StepSolidOptions& options = {});

}  // namespace sketchsplat
