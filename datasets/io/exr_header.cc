// SPDX-License-Identifier: MIT
#include "datasets/io/exr_header.h"

#include <cstdint>

namespace sketchsplat {
namespace {

constexpr std::uint32_t kMultipart = 1 << 12;  // of the version: several headers

std::uint32_t little_endian(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (int k = 3; k >= 0; --k) value = value << 8 | std::uint8_t(bytes[at + k]);
  return value;
}

}  // namespace

// Layout: openexr.com, "OpenEXR File Layout". Magic number, version, then name, type (both end with
// a zero byte), size and value of each attribute; a zero byte ends a header, another one the list
// of headers.
bool exr_sizes_are_believable(const std::string& head, std::size_t file_size) {
  if (head.size() < 8 || head.compare(0, 4, "v/1\1") != 0) return true;
  const bool several = little_endian(head, 4) & kMultipart;
  for (std::size_t at = 8, in_header = 0; at < head.size();) {
    if (head[at] == 0) {
      if (!several || in_header == 0) return true;
      in_header = 0, ++at;
      continue;
    }
    const std::size_t name_end = head.find('\0', at);
    const std::size_t type_end =
        name_end == std::string::npos ? name_end : head.find('\0', name_end + 1);
    if (type_end == std::string::npos || type_end + 5 > head.size()) return true;
    const std::size_t size = little_endian(head, type_end + 1);
    at = type_end + 5;
    if (at + size > file_size) return false;
    at += size, ++in_header;
  }
  return true;
}

}  // namespace sketchsplat
