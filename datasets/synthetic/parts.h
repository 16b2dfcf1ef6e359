// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "datasets/synthetic/brep.h"

namespace sketchsplat {

/// Names of the built-in parts, in the order of the table.
std::vector<std::string> part_names();

/// A built-in part; its dimensions are drawn from `seed` within ranges that keep its shape (same
/// seed, same part). Throws InputError if there is no part of that name.
Brep make_part(const std::string& name, std::uint64_t seed);

}  // namespace sketchsplat
