// SPDX-License-Identifier: MIT
#include "pipelines/pages/page.h"

#include <cstdint>

namespace sketchsplat {

// "<" appears in JSON inside of strings only.
std::string without_tags(const std::string& json) {
  std::string safe;
  safe.reserve(json.size());
  for (const char c : json) {
    if (c == '<')
      safe += "\\u003c";
    else
      safe += c;
  }
  return safe;
}

std::string fill_page(const std::string& page, const std::string& json) {
  const std::string mark = "@DATA@";
  const size_t at = page.find(mark);
  return page.substr(0, at) + without_tags(json) + page.substr(at + mark.size());
}

std::string base64(const std::string& bytes) {
  static const char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t word = 0;
    for (size_t k = 0; k < 3; ++k)
      word = word << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0u);
    for (int k = 3; k >= 0; --k)
      text += i + size_t(3 - k) > bytes.size() ? '=' : kDigits[word >> (6 * k) & 63];
  }
  return text;
}

}  // namespace sketchsplat
