// SPDX-License-Identifier: MIT
#include "sketches/io/json.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>

#include "datasets/types/errors.h"
#include "sketches/io/whole_file.h"

namespace sketchsplat {

using nlohmann::json;

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

template <typename J>
J parse_json(const std::string& text, const std::string& path) {
  const int nesting = json_nesting(text);
  if (nesting > kMostJsonNesting)
    throw InputError(path,
                     "JSON with at most " + std::to_string(kMostJsonNesting) +
                         " arrays and objects in one another",
                     std::to_string(nesting));
  return J::parse(text);
}
template json parse_json(const std::string&, const std::string&);
template Json parse_json(const std::string&, const std::string&);

template <typename J>
J parse_json(std::istream& in, const std::string& path) {
  return parse_json<J>(read_whole(&in, path, kMostJsonBytes), path);
}
template json parse_json(std::istream&, const std::string&);
template Json parse_json(std::istream&, const std::string&);

Json json_of_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  try {
    return parse_json<Json>(in, path);
  } catch (const std::exception&) {
    return {};
  }
}

template <typename J>
std::string json_text(const J& json, int indent) {
  return json.dump(indent, ' ', false, J::error_handler_t::replace);
}
template std::string json_text(const json&, int);
template std::string json_text(const Json&, int);

void print_json(const Json& json) { std::cout << json_text(json, 1) << "\n"; }

namespace {

/// Replaces the number-like words of Python's json module, outside of strings, by null.
std::string without_nan(const std::string& text) {
  std::string out;
  bool quoted = false;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') quoted = !quoted;
    if (quoted && text[i] == '\\' && i + 1 < text.size()) out += text[i++];
    size_t skip = 0;
    for (const char* word : {"NaN", "Infinity", "-Infinity"}) {
      if (!quoted && text.compare(i, std::strlen(word), word) == 0) skip = std::strlen(word);
    }
    skip ? out += "null" : out += text[i];
    if (skip) i += skip - 1;
  }
  return out;
}

std::string describe(const json& value) {
  std::string text = json_text(value);
  if (text.size() > 60) text = text.substr(0, 57) + "...";
  return text;
}

}  // namespace

bool JsonValue::has(const std::string& key) const {
  return json->is_object() && json->contains(key);
}

JsonValue JsonValue::operator[](const std::string& key) const {
  if (!json->is_object()) complain("an object with the key \"" + key + "\"");
  const auto found = json->find(key);
  if (found == json->end()) {
    throw InputError(path, "the key \"" + key + "\"" + (where.empty() ? "" : " in " + where),
                     "none");
  }
  return {{json, &*found}, path, where.empty() ? key : where + "." + key};
}

std::vector<JsonValue> JsonValue::elements(size_t most) const {
  if (!json->is_array()) complain("an array");
  if (json->size() > most)
    throw InputError(path, "at most " + std::to_string(most) + " " + where,
                     std::to_string(json->size()));
  std::vector<JsonValue> all;
  for (size_t i = 0; i < json->size(); ++i) {
    all.push_back({{json, &(*json)[i]}, path, where + "[" + std::to_string(i) + "]"});
  }
  return all;
}

double JsonValue::number() const {
  if (json->is_null()) return std::numeric_limits<double>::quiet_NaN();
  if (!json->is_number()) complain("a number");
  return json->get<double>();
}

double JsonValue::number(const std::string& key, double absent) const {
  if (!has(key)) return absent;
  const JsonValue value = (*this)[key];
  if (!value.json->is_number()) value.complain("a number");
  return value.json->get<double>();
}

std::vector<double> JsonValue::numbers() const {
  if (!json->is_array()) complain("an array");
  std::vector<double> all;
  for (const nlohmann::json& x : *json) {
    if (!x.is_number()) complain("numbers");
    all.push_back(x.get<double>());
  }
  return all;
}

int JsonValue::index(size_t count) const {
  if (!json->is_number_integer() || !(json->get<double>() >= 0) ||
      !(json->get<double>() < double(count)))
    complain("an index below " + std::to_string(count));
  return json->get<int>();
}

void JsonValue::expect_version(int version) const {
  const JsonValue found = (*this)["format_version"];
  if (!found.json->is_number_integer() || found.json->get<double>() != version)
    throw InputError(path, "format_version " + std::to_string(version), describe(*found.json));
}

bool JsonValue::flag() const {
  if (!json->is_boolean()) complain("true or false");
  return json->get<bool>();
}

Eigen::Vector3d JsonValue::point() const {
  constexpr double kLargest = 1e100;  // squares and cubes of it overflow
  if (!json->is_array() || json->size() != 3) complain("three numbers");
  Eigen::Vector3d p;
  for (int k = 0; k < 3; ++k) {
    if (!(*json)[size_t(k)].is_number()) complain("three numbers");
    p[k] = (*json)[size_t(k)].get<double>();
  }
  if (!(p.cwiseAbs().maxCoeff() < kLargest)) complain("numbers below 1e100");
  return p;
}

int JsonValue::positive_integer() const {
  const double value = number();
  if (!(value >= 1 && value <= 1 << 20 && value == int(value))) {
    complain("a positive whole number");
  }
  return int(value);
}

std::string JsonValue::text() const {
  if (!json->is_string()) complain("a text");
  return json->get<std::string>();
}

Eigen::MatrixXd JsonValue::matrix(int rows, int cols) const {
  const std::string expected =
      "a " + std::to_string(rows) + " x " + std::to_string(cols) + " matrix";
  if (!json->is_array() || int(json->size()) < rows) complain(expected);
  Eigen::MatrixXd m(rows, cols);
  for (int r = 0; r < rows; ++r) {
    const JsonValue row{{json, &(*json)[r]}, path, where + "[" + std::to_string(r) + "]"};
    if (!row.json->is_array() || int(row.json->size()) < cols) complain(expected);
    for (int c = 0; c < cols; ++c)
      m(r, c) = JsonValue{{json, &(*row.json)[c]}, path, row.where}.number();
  }
  return m;
}

void JsonValue::complain(const std::string& expected) const {
  throw InputError(path, expected + (where.empty() ? "" : " in " + where), describe(*json));
}

JsonValue read_json(std::istream& in, const std::string& path, const std::string& what) {
  try {
    return {std::make_shared<json>(parse_json<json>(in, path)), path, ""};
  } catch (const json::exception& e) {
    throw InputError(path, what, e.what());
  }
}

JsonValue load_json(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || file.peek() == std::ifstream::traits_type::eof())
    throw InputError(path, "a JSON file", "nothing to read");
  const std::string text = read_whole(&file, path, kMostJsonBytes);
  try {
    const auto value = std::make_shared<json>();
    try {
      *value = parse_json<json>(text, path);
    } catch (const json::parse_error&) {
      *value = json::parse(without_nan(text));  // perhaps because of a NaN
    }
    return {value, path, ""};
  } catch (const json::out_of_range&) {
    throw InputError(path, "numbers below 1.8e308", "a larger one");
  } catch (const json::parse_error& e) {
    throw InputError(path, "a JSON file", "no JSON at byte " + std::to_string(e.byte));
  }
}

}  // namespace sketchsplat
