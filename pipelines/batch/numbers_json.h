// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "pipelines/base/run_report.h"

namespace sketchsplat {

/// An object of named numbers: whole ones as such, null for what is no number.
inline nlohmann::ordered_json numbers_json(const Numbers& numbers) {
  nlohmann::ordered_json object = nlohmann::ordered_json::object();
  for (const auto& [name, value] : numbers) {
    if (!std::isfinite(value))
      object[name] = nullptr;
    else if (std::nearbyint(value) == value && std::abs(value) < 1e15)
      object[name] = std::int64_t(value);
    else
      object[name] = value;
  }
  return object;
}

}  // namespace sketchsplat
