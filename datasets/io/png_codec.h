// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <string>

#include "datasets/io/image_planes.h"

namespace sketchsplat {

/// Decodes a PNG file of `file_size` bytes, whatever its depth, palette or interlacing; samples as
/// stored / largest value. Returns false and says in `found` what is wrong with it.
bool decode_png(FILE* file, size_t file_size, Planes* planes, std::string* found);

/// Reads width and height [px] from the header alone. Returns false if there is none.
bool png_size(FILE* file, int* width, int* height);

/// Encodes 8-bit rows of 1 to 4 interleaved channels, fast rather than small. Returns false and
/// says in `found` what went wrong.
bool encode_png(const unsigned char* rows, int width, int height, int channels, FILE* file,
                std::string* found);

}  // namespace sketchsplat
