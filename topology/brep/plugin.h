// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "topology/brep/compare.h"
#include "topology/brep/mesh_solid.h"
#include "topology/brep/solid_step.h"

namespace sketchsplat {

// Between the program and the plug-in with OpenCASCADE that knows of solids.

/// The plug-in's functions; they throw what those of their headers throw.
struct BrepPlugin {
  SolidCheck (*write_solid_step)(const Solid& solid, const std::string& path,
                                 const StepSolidOptions& options);
  std::vector<FaceMesh> (*mesh_solid)(const Solid& solid, double deflection);
  SolidComparison (*compare_solids)(const std::string& path, const std::string& true_path);
};

constexpr char kBrepPluginFile[] = "sketchsplat_brep.so";
constexpr char kBrepPluginSymbol[] = "sketchsplat_brep_plugin";

}  // namespace sketchsplat
