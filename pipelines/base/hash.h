// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

namespace sketchsplat {

/// 64-bit FNV-1a of some bytes (Fowler, Noll and Vo, RFC 9923).
std::uint64_t hash_number(const std::string& bytes);

/// The same as 16 hexadecimal digits.
std::string hash_of(const std::string& bytes);

/// The same of a file's bytes; of nothing if it cannot be read.
std::string hash_of_file(const std::string& path);

}  // namespace sketchsplat
