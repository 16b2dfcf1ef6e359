// SPDX-License-Identifier: MIT
#include "pipelines/options/scale_reference.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>
#include <vector>

#include "pipelines/base/fields.h"

namespace sketchsplat {
namespace {

using Kind = ScaleReference::Kind;

[[noreturn]] void refuse(const std::string& text) {
  throw UsageError(
      "--scale-by: expected tag=LENGTH, tag:ID=, size=, diameter=, circle:N=, line:N= or "
      "nodes:N-M=, LENGTH in --unit or with mm, cm, m or inch behind it, got '" +
      text + "'");
}

// A whole number and nothing else.
bool parse_index(const std::string& text, int* value) {
  if (text.empty() || text.size() > 9) return false;
  for (const char c : text)
    if (c < '0' || c > '9') return false;
  *value = std::atoi(text.c_str());
  return true;
}

bool parse_length(const std::string& text, ScaleReference* out) {
  char* end = nullptr;
  out->length = std::strtod(text.c_str(), &end);
  if (end == text.c_str() || !(out->length > 0) || !std::isfinite(out->length)) return false;
  std::string unit = end;
  unit.erase(0, std::min(unit.find_first_not_of(' '), unit.size()));
  if (unit.empty()) return true;
  if (unit == "in") unit = "inch";
  const std::vector<std::string> names = length_unit_names();
  const auto at = std::find(names.begin(), names.end(), unit);
  if (at == names.end()) return false;
  out->unit = LengthUnit(at - names.begin());
  return true;
}

// What stands between the colon and the equals sign.
bool parse_numbers(const std::string& text, Kind kind, ScaleReference* out) {
  if (kind != Kind::kNodes) return parse_index(text, &out->first);
  const size_t dash = text.find('-');
  return dash != std::string::npos && parse_index(text.substr(0, dash), &out->first) &&
         parse_index(text.substr(dash + 1), &out->second) && out->first != out->second;
}

}  // namespace

ScaleReference parse_scale_reference(const std::string& text) {
  const size_t equals = text.find('='), colon = text.substr(0, equals).find(':');
  if (equals == std::string::npos) refuse(text);
  const bool numbered = colon != std::string::npos;
  const std::string name = text.substr(0, numbered ? colon : equals);
  const std::pair<std::string, Kind> plain[] = {
      {"tag", Kind::kTag}, {"size", Kind::kSize}, {"diameter", Kind::kDiameter}};
  const std::pair<std::string, Kind> counted[] = {{"tag", Kind::kTag},
                                                  {"circle", Kind::kCircle},
                                                  {"arc", Kind::kCircle},
                                                  {"line", Kind::kLine},
                                                  {"nodes", Kind::kNodes}};
  ScaleReference out;
  bool known = false;
  for (const auto& [word, kind] : plain)
    if (!numbered && word == name) out.kind = kind, known = true;
  for (const auto& [word, kind] : counted)
    if (numbered && word == name) out.kind = kind, known = true;
  if (!known || !parse_length(text.substr(equals + 1), &out) ||
      (numbered && !parse_numbers(text.substr(colon + 1, equals - colon - 1), out.kind, &out)))
    refuse(text);
  return out;
}

}  // namespace sketchsplat
