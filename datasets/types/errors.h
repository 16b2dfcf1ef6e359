// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>

namespace sketchsplat {

/// The input cannot be used. One line: path, what was expected, what was found. Exit status 3.
struct InputError : std::runtime_error {
  InputError(const std::string& path, const std::string& expected, const std::string& found)
      : std::runtime_error(path + ": expected " + expected + ", found " + found) {}
};

/// The scene was read but holds too little to reconstruct. Exit status 4.
struct TooLittleError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The output cannot be written. Exit status 5.
struct OutputError : std::runtime_error {
  OutputError(const std::string& path, const std::string& found)
      : std::runtime_error(path + ": expected a place to write, found " + found) {}
};

}  // namespace sketchsplat
