// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace sketchsplat {

// What there is to know about the built-in parts without OpenCASCADE: their names, and the
// parameters that the draw, the listing and the user's own values share.

/// A dimension of a built-in part. Drawn evenly from [low, high]; users may set it to anything in
/// [least, most], which keeps the part's shape whatever its other dimensions are.
struct PartParameter {
  std::string name;
  std::string unit;  ///< "mm", "deg", "of longest side", "of width", ...; "count": a whole number
  double low = 0, high = 0;
  double least = 0, most = 0;
};

struct PartSpec {
  std::string name;
  std::vector<PartParameter> parameters;  ///< in the order of the draw
};

/// The built-in parts, in the order in which they are listed.
const std::vector<PartSpec>& part_specs();

/// Their names.
std::vector<std::string> part_names();

/// Null if there is no such part.
const PartSpec* find_part(const std::string& name);

/// What users set, by name.
using PartValues = std::vector<std::pair<std::string, double>>;

/// What is wrong with these values for this part, in one sentence that lists its parameters; empty
/// if nothing is.
std::string wrong_values(const PartSpec& spec, const PartValues& values);

/// A value of every parameter.
class Dimensions {
 public:
  explicit Dimensions(std::map<std::string, double> values) : values_(std::move(values)) {}
  /// Throws std::out_of_range if the part declares no such parameter.
  double operator[](const char* name) const { return values_.at(name); }

 private:
  std::map<std::string, double> values_;
};

/// Drawn from `seed` (same seed, same dimensions), then `values` instead of what was drawn: the
/// other dimensions stay what they were. `values` must not be wrong_values().
Dimensions draw(const PartSpec& spec, std::uint64_t seed, const PartValues& values);

/// Lengths in millimetres, whatever they are relative to, and angles in radians. What is no length
/// ("of the pitch", %, counts) stays as it is.
Dimensions in_model_units(const PartSpec& spec, const Dimensions& dimensions);

/// All parts, or one, with their parameters and ranges: a table for the terminal.
std::string part_listing(const std::vector<PartSpec>& specs);

}  // namespace sketchsplat
