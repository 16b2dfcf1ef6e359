// SPDX-License-Identifier: MIT
#include "pipelines/base/hash.h"

#include <cstdio>
#include <fstream>
#include <iterator>

namespace sketchsplat {

std::uint64_t hash_number(const std::string& bytes) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : bytes) hash = (hash ^ std::uint8_t(c)) * 0x100000001b3u;
  return hash;
}

std::string hash_of(const std::string& bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash_number(bytes)));
  return text;
}

std::string hash_of_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return hash_of({std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()});
}

}  // namespace sketchsplat
