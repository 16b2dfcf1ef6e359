// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

namespace sketchsplat {

/// Writes a file whole or not at all: under a temporary name in its folder, which must exist, then
/// renamed. Throws OutputError.
void write_whole(const std::string& path, const std::string& bytes);

/// The same by `write`, which gets the temporary name and returns what went wrong, or nothing.
void write_whole(const std::string& path,
                 const std::function<std::string(const std::string& temporary)>& write);

}  // namespace sketchsplat
