// SPDX-License-Identifier: MIT
#include "sketches/io/json_text.h"

#include <algorithm>

namespace sketchsplat {

int json_nesting(const std::string& text) {
  int depth = 0, deepest = 0;
  bool quoted = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c == '\\') ++i;
      quoted = c != '"';
    } else if (c == '[' || c == '{') {
      deepest = std::max(deepest, ++depth);
    } else if (c == ']' || c == '}') {
      --depth;
    } else {
      quoted = c == '"';
    }
  }
  return deepest;
}

}  // namespace sketchsplat
