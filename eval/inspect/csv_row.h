// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "sketches/io/io_number.h"

namespace sketchsplat {

/// To nine digits: more is not measured, and files stay readable.
inline double nine_digits(double x) {
  if (!std::isfinite(x)) return x;
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", x);
  return std::strtod(text, nullptr);
}

/// Fields of a CSV row with commas between them; numbers that are not finite are empty. Texts hold
/// no commas.
class CsvRow {
 public:
  CsvRow& add(const std::string& text) {
    line_ += (fields_++ ? "," : "") + text;
    return *this;
  }
  CsvRow& add(double x) { return add(std::isfinite(x) ? shortest(nine_digits(x)) : std::string()); }
  CsvRow& skip(int count) {
    for (int i = 0; i < count; ++i) add(std::string());
    return *this;
  }
  std::string text() const { return line_ + "\n"; }

 private:
  std::string line_;
  int fields_ = 0;
};

}  // namespace sketchsplat
