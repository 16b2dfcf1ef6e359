// SPDX-License-Identifier: MIT
#include "pipelines/results/brep_plugin.h"

#include "pipelines/base/plugin_path.h"

namespace sketchsplat {

const BrepPlugin& brep_plugin() {
  static const auto* const plugin = static_cast<const BrepPlugin*>(
      plugin_table(kBrepPluginFile, SKETCHSPLAT_BREP_FOLDER, kBrepPluginSymbol));
  return *plugin;
}

}  // namespace sketchsplat
