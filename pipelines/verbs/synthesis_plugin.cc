// SPDX-License-Identifier: MIT
#include "pipelines/verbs/synthesis_plugin.h"

#include <dlfcn.h>

#include <stdexcept>
#include <string>

#include "pipelines/base/plugin_path.h"
#include "pipelines/command/cli.h"

namespace sketchsplat {
namespace {

const SynthesisPlugin* load_plugin() {
  const std::string path = synthesis_plugin_path();
  void* library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library)
    throw std::runtime_error(std::string(kSynthesisPluginFile) +
                             " cannot be loaded: " + ::dlerror());
  using Get = const SynthesisPlugin*();
  return reinterpret_cast<Get*>(::dlsym(library, kSynthesisPluginSymbol))();
}

}  // namespace

std::string synthesis_plugin_path() {
  return plugin_path(kSynthesisPluginFile, SKETCHSPLAT_SYNTHESIS_FOLDER);
}

const SynthesisPlugin& synthesis_plugin() {
  static const SynthesisPlugin* const plugin = load_plugin();
  return *plugin;
}

}  // namespace sketchsplat
