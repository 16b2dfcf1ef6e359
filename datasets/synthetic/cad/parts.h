// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "datasets/synthetic/cad/brep.h"
#include "datasets/synthetic/catalogue/part_table.h"

namespace sketchsplat {

/// A built-in part; its dimensions are drawn from `seed` within ranges that keep its shape (same
/// seed, same part), except those that `values` sets. Throws InputError if there is no part of that
/// name, or if it has no such dimension or not in that range.
Brep make_part(const std::string& name, std::uint64_t seed, const PartValues& values = {});

}  // namespace sketchsplat
