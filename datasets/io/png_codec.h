// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "datasets/io/image_planes.h"

namespace sketchsplat {

/// Decodes a PNG file, whatever its depth, palette or interlacing; samples as stored / largest
/// value. Returns false with what is wrong in `found`.
bool decode_png(const std::string& file, Planes* planes, std::string* found);

/// Width and height [px] from the header, for which the first 24 bytes are enough. Returns false if
/// there is none.
bool png_size(const std::string& file, int* width, int* height);

/// PNG of 8-bit rows of 1 to 4 interleaved channels, fast rather than small. Returns false with
/// what went wrong in `found`.
bool encode_png(const unsigned char* rows, int width, int height, int channels, std::string* bytes,
                std::string* found);

}  // namespace sketchsplat
