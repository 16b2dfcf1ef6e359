// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <istream>
#include <string>

namespace sketchsplat {

// Sizes of files beyond which nobody means them: what claims more is refused before memory is
// taken.
constexpr std::int64_t kMostFileBytes = 1'000'000'000;  ///< models, meshes, points
constexpr std::int64_t kMostJsonBytes = 250'000'000;    ///< takes eight times as much once parsed

/// Throws InputError if more than `most` bytes are left of a stream. One that cannot be measured (a
/// pipe) passes.
void check_length(std::istream* in, const std::string& path, std::int64_t most = kMostFileBytes);

/// All that is left of a stream. Throws InputError if that is more than `most` bytes.
std::string read_whole(std::istream* in, const std::string& path, std::int64_t most);

}  // namespace sketchsplat
