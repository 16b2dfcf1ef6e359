// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <iosfwd>
#include <string>

namespace sketchsplat {

/// Writes a file whole or not at all: to a temporary name beside it, then renames. If `write`
/// throws, or the disk is full, an older file of that name stays as it was. Throws OutputError, and
/// whatever `write` throws.
void write_atomically(const std::string& path, const std::function<void(std::ostream&)>& write);

void write_text(const std::string& path, const std::string& text);

/// Makes the folder, and those above it, and tries whether files can be made in it: before hours of
/// work, not after. Throws OutputError.
void prepare_output_folder(const std::string& folder);

}  // namespace sketchsplat
