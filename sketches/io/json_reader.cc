// SPDX-License-Identifier: MIT
#include "sketches/io/json_reader.h"

#include <nlohmann/json.hpp>

#include "datasets/types/errors.h"

namespace sketchsplat {

void JsonReader::fail(const std::string& expected, const std::string& found) const {
  throw InputError(path_, expected, found);
}

const Json& JsonReader::member(const Json& object, const char* key,
                               const std::string& where) const {
  if (!object.is_object()) fail("an object as " + where, object.type_name());
  const auto it = object.find(key);
  if (it == object.end()) fail("\"" + std::string(key) + "\" in " + where, "no such key");
  return *it;
}

const Json& JsonReader::array(const Json& object, const char* key, const std::string& where,
                              size_t most) const {
  const Json& a = member(object, key, where);
  if (!a.is_array()) fail("an array as \"" + std::string(key) + "\" in " + where, a.type_name());
  if (a.size() > most)
    fail("at most " + std::to_string(most) + " " + key + " in " + where, std::to_string(a.size()));
  return a;
}

Eigen::Vector3d JsonReader::point(const Json& j, const std::string& where) const {
  if (!j.is_array() || j.size() != 3) fail("three numbers as " + where, summary(j));
  for (const Json& x : j)
    if (!x.is_number()) fail("three numbers as " + where, summary(j));
  const Eigen::Vector3d p(j[0].get<double>(), j[1].get<double>(), j[2].get<double>());
  constexpr double kLargest = 1e100;  // squares and cubes of it overflow
  if (!(p.cwiseAbs().maxCoeff() < kLargest)) fail("numbers below 1e100 as " + where, summary(j));
  return p;
}

double JsonReader::number(const Json& object, const char* key, double absent,
                          const std::string& where) const {
  const auto it = object.find(key);
  if (it == object.end()) return absent;
  if (!it->is_number())
    fail("a number as \"" + std::string(key) + "\" in " + where, summary(*it));
  return it->get<double>();
}

int JsonReader::integer(const Json& j, const std::string& what) const {
  if (!j.is_number_integer() || j.get<double>() < 0 || j.get<double>() > 2e9)
    fail(what, summary(j));
  return j.get<int>();
}

std::string JsonReader::summary(const Json& j) {
  const std::string text = json_text(j);
  return text.size() <= 60 ? text : text.substr(0, 57) + "...";
}

}  // namespace sketchsplat
