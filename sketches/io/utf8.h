// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

namespace sketchsplat {

/// The code point at `i` of UTF-8 text, and `i` moved behind it; U+FFFD for what is no UTF-8.
inline uint32_t next_code_point(const std::string& text, size_t* i) {
  const auto byte = [&](size_t k) -> uint32_t { return k < text.size() ? uint8_t(text[k]) : 0; };
  const uint32_t first = byte((*i)++);
  const int more = first < 0x80       ? 0
                   : first >> 5 == 6  ? 1
                   : first >> 4 == 14 ? 2
                   : first >> 3 == 30 ? 3
                                      : -1;
  if (more == 0) return first;
  if (more < 0) return 0xfffd;
  uint32_t code = first & (0x3f >> more);
  for (int k = 0; k < more; ++k) {
    if (byte(*i) >> 6 != 2) return 0xfffd;
    code = code << 6 | (byte((*i)++) & 0x3f);
  }
  return code > 0x10ffff ? 0xfffd : code;
}

}  // namespace sketchsplat
