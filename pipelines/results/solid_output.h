// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "eval/solids/solid_tables.h"
#include "pipelines/results/known_scale.h"
#include "sketches/io/io.h"
#include "topology/brep/mesh_solid.h"
#include "topology/brep/solid_step.h"
#include "topology/solid/find_solid.h"

namespace sketchsplat {

/// What became of the solid, for reports.
struct SolidOutcome {
  SolidSearch search;
  SolidCheck check;  ///< of the boundary representation; empty if there was nothing to check
  bool written = false;
  std::string why;                    ///< if not: a clause
  std::optional<SolidTables> tables;  ///< of the solid that was written
  std::vector<FaceMesh> mesh;         ///< of the solid that was written
};

/// How solids are written, and what is known beside them.
struct SolidOutputOptions {
  StepSolidOptions step;
  KnownScale scale;
  SigmaModel sigma;          ///< of the strokes, without alignment
  std::string extra = "{}";  ///< JSON object: further members of solid.json
};

/// Checks the solid that was found and writes it to `folder`: solid.step, solid.json, surfaces.csv
/// and dimensions.csv. What is not valid is not written, and files of an earlier run go. Throws
/// OutputError.
SolidOutcome write_solid(const std::string& folder, const SolidSearch& search,
                         const SolidOutputOptions& options);

/// JSON object: written, why, curves in doubt, numbers of faces by surface, volume, area and
/// tolerance in world units, inferred edges, margin in nats, surfaces and dimensions as in their
/// tables.
std::string solid_json(const SolidOutcome& outcome);

}  // namespace sketchsplat
