// SPDX-License-Identifier: MIT
// In: the options of a verb. Out: its work done, through results and the method.
// This folder may not include bench, batch or program.
#pragma once

#include "datasets/synthetic/write/plugin.h"

namespace sketchsplat {

/// The plug-in with OpenCASCADE, loaded on the first call. Throws std::runtime_error if it is
/// nowhere.
const SynthesisPlugin& synthesis_plugin();

}  // namespace sketchsplat
