// SPDX-License-Identifier: MIT
#pragma once

#include <iostream>
#include <nlohmann/json.hpp>

namespace sketchsplat {

/// Results on standard output, for --json. Names of files may hold bytes that are no UTF-8.
inline void print_json(const nlohmann::ordered_json& json) {
  std::cout << json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) << "\n";
}

}  // namespace sketchsplat
