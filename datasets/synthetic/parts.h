// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <iterator>
#include <string>
#include <vector>

#include "datasets/synthetic/brep.h"

namespace sketchsplat {

/// Names of the built-in parts, in the order of the table. Here, so that nobody needs OpenCASCADE
/// to know them.
inline constexpr const char* kPartNames[] = {
    "box",        "box-hole",    "plate-holes",   "stepped-shaft", "l-bracket", "pocket-block",
    "box-fillet", "box-chamfer", "slotted-sheet", "cut-cylinder",  "frustum",   "hex-nut",
    "dome-plate", "flange",      "tee",           "u-channel"};
inline std::vector<std::string> part_names() {
  return {std::begin(kPartNames), std::end(kPartNames)};
}

/// A built-in part; its dimensions are drawn from `seed` within ranges that keep its shape (same
/// seed, same part). Throws InputError if there is no part of that name.
Brep make_part(const std::string& name, std::uint64_t seed);

}  // namespace sketchsplat
