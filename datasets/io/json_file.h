// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <string>

namespace sketchsplat {

/// A value inside of a JSON file, with what is needed to complain about it.
struct JsonValue {
  const nlohmann::json* json;
  std::string path;   ///< of the file
  std::string where;  ///< e.g. "frames[3]"; empty for the whole file

  bool has(const std::string& key) const;
  /// Member of an object. Throws InputError that names the key if it is not there.
  JsonValue operator[](const std::string& key) const;
  /// Elements of an array; throws InputError if it is none.
  std::vector<JsonValue> elements() const;

  double number() const;         ///< NaN if null. Throws InputError.
  int positive_integer() const;  ///< Throws InputError.
  std::string text() const;      ///< Throws InputError.
  /// Nested rows of at least `rows` x `cols` numbers, of which the top-left block is returned; null
  /// numbers become NaN. Throws InputError.
  Eigen::MatrixXd matrix(int rows, int cols) const;

  [[noreturn]] void complain(const std::string& expected) const;
};

/// Parses a file. NaN and Infinity, which Python writes although JSON has no such numbers, become
/// null. Throws InputError (one line).
nlohmann::json load_json(const std::string& path);

}  // namespace sketchsplat
