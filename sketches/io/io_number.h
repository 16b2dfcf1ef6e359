// SPDX-License-Identifier: MIT
#pragma once

#include <charconv>
#include <string>

namespace sketchsplat {

/// The shortest decimal text that reads back as the same number, whatever the locale.
inline std::string shortest(double x) {
  char text[32];
  return std::string(text, std::to_chars(text, text + sizeof(text), x).ptr);
}

}  // namespace sketchsplat
