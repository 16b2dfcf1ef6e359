// SPDX-License-Identifier: MIT
#pragma once

#include "topology/brep/plugin.h"

namespace sketchsplat {

/// The plug-in with OpenCASCADE, loaded on the first call. Throws std::runtime_error if it is
/// nowhere.
const BrepPlugin& brep_plugin();

}  // namespace sketchsplat
