// SPDX-License-Identifier: MIT
#include "datasets/io/write_whole.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "datasets/types/errors.h"

namespace sketchsplat {

void write_whole(const std::string& path,
                 const std::function<std::string(const std::string& temporary)>& write) {
  const std::string temporary = path + "." + std::to_string(::getpid()) + ".part";
  std::string found = write(temporary);
  if (found.empty() && std::rename(temporary.c_str(), path.c_str()) != 0)
    found = std::strerror(errno);
  if (found.empty()) return;
  std::remove(temporary.c_str());
  throw OutputError(path, found);
}

void write_whole(const std::string& path, const std::string& bytes) {
  write_whole(path, [&](const std::string& temporary) -> std::string {
    FILE* file = std::fopen(temporary.c_str(), "wb");
    if (!file) return std::strerror(errno);
    const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
    return std::fclose(file) == 0 && written ? "" : std::strerror(errno);
  });
}

}  // namespace sketchsplat
