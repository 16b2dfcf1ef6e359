// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "datasets/synthetic/render/cad_part.h"
#include "datasets/synthetic/scene/synthesize.h"

namespace sketchsplat {

// Between the program and the plug-in with OpenCASCADE, whose 40 shared objects take longer to load
// than all the others; only `synthesize`, and `inspect` with a STEP file, need them.

/// The plug-in's functions; they throw what those of synthesize.h throw.
struct SynthesisPlugin {
  SyntheticScene* (*synthesize)(const SynthesizeOptions& options);  ///< to be released
  void (*write_scene)(const SyntheticScene& scene, const std::string& folder);
  void (*release)(SyntheticScene* scene);
  CadPart* (*read_cad)(const std::string& path, double smooth_angle_deg);  ///< to be released
  std::vector<int> (*count_views)(CadPart* part, const std::vector<View>& views,
                                  const Eigen::Matrix3Xd& points, const std::vector<int>& strokes);
  void (*release_cad)(CadPart* part);
};

constexpr char kSynthesisPluginFile[] = "sketchsplat_synthesis.so";
constexpr char kSynthesisPluginSymbol[] = "sketchsplat_synthesis_plugin";

}  // namespace sketchsplat
