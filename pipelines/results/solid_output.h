// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "sketches/io/io.h"
#include "topology/brep/solid_step.h"
#include "topology/solid/find_solid.h"

namespace sketchsplat {

/// What became of the solid, for reports.
struct SolidOutcome {
  SolidSearch search;
  SolidCheck check;  ///< of the boundary representation; empty if there was nothing to check
  bool written = false;
  std::string why;  ///< if not: a clause
};

/// Checks the solid that was found and writes `folder`/solid.step; if there is none that is valid,
/// nothing is written and a file of an earlier run goes. Throws OutputError.
SolidOutcome write_solid(const std::string& folder, const SolidSearch& search,
                         const StepSolidOptions& options);

/// JSON object: written, why, curves in doubt, numbers of faces by surface, volume, area and
/// tolerance in world units, inferred edges, margin in nats.
std::string solid_json(const SolidOutcome& outcome);

}  // namespace sketchsplat
