// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <string>

#include "datasets/io/image_planes.h"

namespace sketchsplat {

/// Decodes a JPEG file that is not empty: one plane of grey or three of RGB, samples / 255. A
/// `denominator` of 2, 4 or 8 gives pictures so much smaller, rounded up, at a fraction of the time
/// (libjpeg averages while it decodes); with 1 the picture is whole. EXIF is not looked at: the
/// rows stay as the sensor wrote them, as COLMAP calibrates them. Returns false and says in `found`
/// what is wrong; `found` stays empty if the file holds colours for printers (CMYK), which this
/// does not know.
bool decode_jpeg(const std::string& bytes, int denominator, Planes* planes, std::string* found);

/// Baseline JPEG of 8-bit rows of three interleaved channels; quality in [1, 100]. Returns false
/// and says in `found` what is wrong.
bool encode_jpeg(const unsigned char* rows, int width, int height, int quality, std::string* bytes,
                 std::string* found);

/// Reads width and height [px] from the header alone. Returns false if there is none.
bool jpeg_size(FILE* file, int* width, int* height);

}  // namespace sketchsplat
