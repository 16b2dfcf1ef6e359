// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstring>
#include <string>

namespace sketchsplat {

/// Appends four bytes, the lowest first, as binary formats want them on every machine.
inline void append(std::uint32_t bits, std::string* bytes) {
  for (int shift = 0; shift < 32; shift += 8) bytes->push_back(char(bits >> shift & 0xff));
}
inline void append(float x, std::string* bytes) {
  std::uint32_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  append(bits, bytes);
}

}  // namespace sketchsplat
