// SPDX-License-Identifier: MIT
#include "pipelines/base/atomic_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "datasets/types/errors.h"

namespace sketchsplat {
namespace fs = std::filesystem;
namespace {

// Removes the temporary file unless it became the real one.
struct Leftover {
  std::string path;
  bool done = false;
  ~Leftover() {
    if (!done) std::remove(path.c_str());
  }
};

std::string reason() { return errno ? std::strerror(errno) : "an error of the file system"; }

}  // namespace

void write_atomically(const std::string& path, const std::function<void(std::ostream&)>& write) {
  Leftover temporary = {path + ".part" + std::to_string(getpid())};
  {
    errno = 0;
    std::ofstream out(temporary.path, std::ios::binary | std::ios::trunc);
    if (!out) throw OutputError(path, reason());
    write(out);
    out.close();
    if (!out) throw OutputError(path, reason());
  }
  std::error_code error;
  fs::rename(temporary.path, path, error);
  if (error) throw OutputError(path, error.message());
  temporary.done = true;
}

void write_text(const std::string& path, const std::string& text) {
  write_atomically(path, [&](std::ostream& out) { out << text; });
}

void prepare_output_folder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  std::error_code none;
  if (!fs::is_directory(folder, none)) {
    throw OutputError(folder, error ? error.message() : "a file of that name");
  }
  const Leftover probe = {folder + "/.probe" + std::to_string(getpid())};
  errno = 0;
  if (!std::ofstream(probe.path)) throw OutputError(folder, reason());
}

}  // namespace sketchsplat
