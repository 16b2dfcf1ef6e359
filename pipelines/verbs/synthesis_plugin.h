// SPDX-License-Identifier: MIT
#pragma once

#include "datasets/synthetic/write/plugin.h"

namespace sketchsplat {

/// The plug-in with OpenCASCADE, loaded on the first call. Throws std::runtime_error if it is
/// nowhere.
const SynthesisPlugin& synthesis_plugin();

}  // namespace sketchsplat
