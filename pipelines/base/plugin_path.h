// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace sketchsplat {

/// Where a plug-in lies: beside the executable, where it is installed (beside the library, if this
/// is part of one), or in the folder where it was built. If it is nowhere: the last of these.
std::string plugin_path(const std::string& file, const std::string& built);

/// The table of functions that a plug-in's `symbol`, a function without arguments, returns; the
/// plug-in stays loaded. Throws std::runtime_error if it cannot be.
const void* plugin_table(const std::string& file, const std::string& built, const char* symbol);

}  // namespace sketchsplat
