// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "datasets/synthetic/synthesize.h"

namespace sketchsplat {

// Between the program and the plug-in with OpenCASCADE, whose 40 shared objects take longer to load
// than all the others; only `synthesize` needs them.

/// The plug-in's functions; they throw what those of synthesize.h throw.
struct SynthesisPlugin {
  SyntheticScene* (*synthesize)(const SynthesizeOptions& options);  ///< to be released
  void (*write_scene)(const SyntheticScene& scene, const std::string& folder);
  void (*release)(SyntheticScene* scene);
};

constexpr char kSynthesisPluginFile[] = "sketchsplat_synthesis.so";
constexpr char kSynthesisPluginSymbol[] = "sketchsplat_synthesis_plugin";

}  // namespace sketchsplat
