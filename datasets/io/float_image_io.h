// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "datasets/types/image.h"

namespace sketchsplat {

// OpenImageIO does the work and is loaded on the first call. Safe from many threads.

/// One channel of an OpenEXR file.
struct FloatChannel {
  std::string name;  ///< "Z" is a depth; "R", "G", "B" are what most programs show
  Image<float> values;
};

/// Writes OpenEXR (zip), 32 bits per number or 16 if `half`, whole or not at all. The channels have
/// one size and are at least one. The folder must exist. Throws OutputError.
void write_exr(const std::string& path, const std::vector<FloatChannel>& channels, bool half);

/// All channels of an OpenEXR file, values as they are. Throws InputError.
std::vector<FloatChannel> read_exr(const std::string& path);

}  // namespace sketchsplat
