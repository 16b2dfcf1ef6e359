// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <istream>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace sketchsplat {

// Reading and writing of JSON, compiled here once: parsing alone costs the compiler three seconds a
// file. <nlohmann/json.hpp> belongs into .cc files, and into few of them.

/// Members of objects stay in the order in which they are put: what is written.
using Json = nlohmann::ordered_json;

/// Arrays and objects in one another that a file may hold. Ours and everybody's need fewer than
/// ten; copying and printing values recurses, so that some ten thousand of them end the program.
constexpr int kMostJsonNesting = 100;

/// How deep arrays and objects stand in one another in a text of JSON; brackets in strings do not
/// count.
int json_nesting(const std::string& text);

/// Parses a text as J::parse does (J: Json, or nlohmann::json, which is fast with objects of many
/// members), and throws what that throws; InputError that names `path` if it is nested too deeply.
template <typename J>
J parse_json(const std::string& text, const std::string& path = "JSON of our own");
/// The same of a whole stream; InputError if it is longer than kMostJsonBytes.
template <typename J>
J parse_json(std::istream& in, const std::string& path);

/// Null if there is no such file, or no JSON in it.
Json json_of_file(const std::string& path);

/// On one line, or by lines that are indented by so many blanks a level. What is no UTF-8 (names of
/// files may hold it) is replaced.
template <typename J>
std::string json_text(const J& json, int indent = -1);

/// A result on standard output, for --json.
void print_json(const Json& json);

/// A value inside of a JSON file, with what is needed to complain about it. Copies share the file.
struct JsonValue {
  std::shared_ptr<const nlohmann::json> json;
  std::string path;   ///< of the file
  std::string where;  ///< e.g. "frames[3]"; empty for the whole file

  bool has(const std::string& key) const;
  /// Member of an object. Throws InputError that names the key if it is not there.
  JsonValue operator[](const std::string& key) const;
  // All of these throw InputError.
  /// Elements of an array of at most so many.
  std::vector<JsonValue> elements(size_t most = size_t(-1)) const;
  double number() const;  ///< NaN if null
  /// Member of an object that need not be there, but must not be null.
  double number(const std::string& key, double absent) const;
  std::vector<double> numbers() const;  ///< of an array, none of them null
  int positive_integer() const;
  int index(size_t count) const;  ///< from 0, below `count`
  /// Of an object whose "format_version" is not this.
  void expect_version(int version) const;
  bool flag() const;
  std::string text() const;
  Eigen::Vector3d point() const;  ///< three numbers below 1e100
  /// Nested rows of at least `rows` x `cols` numbers, of which the top-left block is returned; null
  /// numbers become NaN.
  Eigen::MatrixXd matrix(int rows, int cols) const;

  [[noreturn]] void complain(const std::string& expected) const;
};

/// Parses what is left of a stream. Throws InputError that names `path` and says that it is not
/// `what`, e.g. "a sketch as JSON".
JsonValue read_json(std::istream& in, const std::string& path, const std::string& what);

/// Parses a file. NaN and Infinity, which Python writes although JSON has no such numbers, become
/// null. Throws InputError (one line).
JsonValue load_json(const std::string& path);

}  // namespace sketchsplat
