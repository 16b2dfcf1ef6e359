// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace sketchsplat {

/// Whether no attribute in the headers of an OpenEXR file claims more bytes than the file has, nor
/// others than its type takes, and no window more than `per_byte` bytes of pixels for each byte of
/// the file: the library takes memory for what is claimed, up to 2 GB for each attribute, and reads
/// some by their type alone. `head`: the file or its beginning. What is no such file or has no end
/// within `head` is left to the library.
bool exr_sizes_are_believable(const std::string& head, std::size_t file_size,
                              double per_byte = 20000);

}  // namespace sketchsplat
