// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>

#include "sketches/io/json.h"

namespace sketchsplat {

/// Reads values and says where in the file the unusable one is: InputError.
class JsonReader {
 public:
  explicit JsonReader(const std::string& path) : path_(path) {}

  [[noreturn]] void fail(const std::string& expected, const std::string& found) const;
  const Json& member(const Json& object, const char* key, const std::string& where) const;
  /// Of at most so many.
  const Json& array(const Json& object, const char* key, const std::string& where,
                    size_t most = size_t(-1)) const;
  Eigen::Vector3d point(const Json& j, const std::string& where) const;
  double number(const Json& object, const char* key, double absent, const std::string& where) const;
  int integer(const Json& j, const std::string& what) const;
  static std::string summary(const Json& j);

 private:
  std::string path_;
};

}  // namespace sketchsplat
