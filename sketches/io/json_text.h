// SPDX-License-Identifier: MIT
#pragma once

#include <istream>
#include <string>

#include "datasets/types/errors.h"
#include "sketches/io/whole_file.h"

namespace sketchsplat {

/// Arrays and objects in one another that a file may hold. Ours and everybody's need fewer than
/// ten; copying and printing values recurses, so that some ten thousand of them end the program.
constexpr int kMostJsonNesting = 100;

/// How deep arrays and objects stand in one another in a text of JSON; brackets in strings do not
/// count.
int json_nesting(const std::string& text);

/// Parses a text as Json::parse does (Json: nlohmann's json or ordered_json), and throws what that
/// throws; InputError that names `path` if it is nested too deeply.
template <typename Json>
Json parse_json_text(const std::string& text, const std::string& path) {
  const int nesting = json_nesting(text);
  if (nesting > kMostJsonNesting)
    throw InputError(path,
                     "JSON with at most " + std::to_string(kMostJsonNesting) +
                         " arrays and objects in one another",
                     std::to_string(nesting));
  return Json::parse(text);
}

/// The same of a whole stream; InputError if it is longer than kMostJsonBytes.
template <typename Json>
Json parse_json(std::istream& in, const std::string& path) {
  return parse_json_text<Json>(read_whole(&in, path, kMostJsonBytes), path);
}

}  // namespace sketchsplat
