// SPDX-License-Identifier: MIT
#include "pipelines/base/plugin_path.h"

#include <dlfcn.h>

#include <filesystem>
#include <stdexcept>

namespace sketchsplat {

namespace {

// The executable or the library that this code is part of.
std::filesystem::path own_folder() {
  Dl_info info;
  if (!::dladdr(reinterpret_cast<const void*>(&plugin_path), &info) || !info.dli_fname) return {};
  std::error_code none;
  return std::filesystem::canonical(info.dli_fname, none).parent_path();
}

}  // namespace

std::string plugin_path(const std::string& file, const std::string& built) {
  namespace fs = std::filesystem;
  std::error_code none;
  const fs::path bin = fs::read_symlink("/proc/self/exe", none).parent_path();
  // Without /proc our place is unknown; the current folder must not be searched.
  for (const fs::path& folder : {bin, bin / ".." / "lib" / "sketchsplat"})
    if (!bin.empty() && fs::exists(folder / file, none)) return folder / file;
  const fs::path own = own_folder();
  if (!own.empty() && fs::exists(own / "sketchsplat" / file, none))
    return own / "sketchsplat" / file;
  return fs::path(built) / file;
}

const void* plugin_table(const std::string& file, const std::string& built, const char* symbol) {
  void* library = ::dlopen(plugin_path(file, built).c_str(), RTLD_NOW | RTLD_LOCAL);
  void* get = library ? ::dlsym(library, symbol) : nullptr;
  if (!get) throw std::runtime_error(file + " cannot be loaded: " + ::dlerror());
  return reinterpret_cast<const void* (*)()>(get)();
}

}  // namespace sketchsplat
