// SPDX-License-Identifier: MIT
#include "pipelines/results/brep_plugin.h"

#include <dlfcn.h>

#include <stdexcept>
#include <string>

#include "pipelines/base/plugin_path.h"

namespace sketchsplat {
namespace {

const BrepPlugin* load_plugin() {
  const std::string path = plugin_path(kBrepPluginFile, SKETCHSPLAT_BREP_FOLDER);
  void* library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library)
    throw std::runtime_error(std::string(kBrepPluginFile) + " cannot be loaded: " + ::dlerror());
  using Get = const BrepPlugin*();
  return reinterpret_cast<Get*>(::dlsym(library, kBrepPluginSymbol))();
}

}  // namespace

const BrepPlugin& brep_plugin() {
  static const BrepPlugin* const plugin = load_plugin();
  return *plugin;
}

}  // namespace sketchsplat
