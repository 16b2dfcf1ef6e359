// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

namespace sketchsplat {

/// On one line, without what terminals obey: names and texts out of files hold anything.
inline std::string one_line(std::string text) {
  for (char& c : text)
    if ((c >= 0 && c < ' ') || c == 127) c = ' ';
  return text;
}

/// The same, as long as people read; cut between letters of UTF-8.
inline std::string short_line(std::string text) {
  constexpr std::size_t kMost = 800;
  if (text.size() <= kMost) return one_line(std::move(text));
  std::size_t end = kMost;
  while (end > 0 && (text[end] & 0xC0) == 0x80) --end;
  return one_line(text.substr(0, end) + "...");
}

/// The input cannot be used. One line: path, what was expected, what was found. Exit status 3.
struct InputError : std::runtime_error {
  InputError(const std::string& path, const std::string& expected, const std::string& found)
      : std::runtime_error(one_line(path) + ": expected " + short_line(expected) + ", found " +
                           short_line(found)) {}
  /// The line of an InputError that another process has met.
  explicit InputError(const std::string& line) : std::runtime_error(one_line(line)) {}
};

/// The scene was read but holds too little to reconstruct. Exit status 4.
struct TooLittleError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The output cannot be written. Exit status 5.
struct OutputError : std::runtime_error {
  OutputError(const std::string& path, const std::string& found)
      : std::runtime_error(one_line(path) + ": expected a place to write, found " +
                           short_line(found)) {}
};

}  // namespace sketchsplat
