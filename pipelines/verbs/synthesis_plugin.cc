// SPDX-License-Identifier: MIT
#include "pipelines/verbs/synthesis_plugin.h"

#include "pipelines/base/plugin_path.h"

namespace sketchsplat {
std::string synthesis_plugin_path() {
  return plugin_path(kSynthesisPluginFile, SKETCHSPLAT_SYNTHESIS_FOLDER);
}

const SynthesisPlugin& synthesis_plugin() {
  static const auto* const plugin = static_cast<const SynthesisPlugin*>(
      plugin_table(kSynthesisPluginFile, SKETCHSPLAT_SYNTHESIS_FOLDER, kSynthesisPluginSymbol));
  return *plugin;
}

}  // namespace sketchsplat
