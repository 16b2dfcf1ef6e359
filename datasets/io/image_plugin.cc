// SPDX-License-Identifier: MIT
#include "datasets/io/image_plugin.h"

#include <dlfcn.h>

#include <filesystem>

namespace sketchsplat {
namespace {

const ImagePlugin* load_plugin() {
  namespace fs = std::filesystem;
  std::error_code none;
  const fs::path bin = fs::read_symlink("/proc/self/exe", none).parent_path();
  Dl_info here = {};  // the library that holds this, if one does
  fs::path beside;
  if (::dladdr(reinterpret_cast<const void*>(&load_plugin), &here) && here.dli_fname)
    beside = fs::path(here.dli_fname).parent_path() / "sketchsplat";
  for (const fs::path& folder :
       {bin, bin / ".." / "lib" / "sketchsplat", beside, fs::path(SKETCHSPLAT_PLUGIN_FOLDER)}) {
    if (!folder.is_absolute()) continue;  // without /proc nobody knows where we are
    void* library = ::dlopen((folder / kImagePluginFile).c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) continue;
    using Get = const ImagePlugin*();
    return reinterpret_cast<Get*>(::dlsym(library, kImagePluginSymbol))();
  }
  return nullptr;
}

}  // namespace

const ImagePlugin* image_plugin() {
  static const ImagePlugin* const plugin = load_plugin();
  return plugin;
}

}  // namespace sketchsplat
