// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "datasets/io/image_planes.h"

namespace sketchsplat {

/// Decodes a JPEG file: one plane of grey or three of RGB, samples / 255. A `denominator` of 2, 4
/// or 8 gives pictures so much smaller, rounded up, at a fraction of the time (the library averages
/// while it decodes); with 1 the picture is whole. EXIF is not looked at: the rows stay as the
/// sensor wrote them, as COLMAP calibrates them. Returns false with what is wrong in `found`, which
/// stays empty if the file is of a kind that this does not decode: CMYK, or rare subsampling.
bool decode_jpeg(const std::string& file, int denominator, Planes* planes, std::string* found);

/// Baseline JPEG of 8-bit rows of three interleaved channels, colours at half of the resolution;
/// quality in [1, 100]. Returns false with what is wrong in `found`.
bool encode_jpeg(const unsigned char* rows, int width, int height, int quality, std::string* bytes,
                 std::string* found);

/// Width and height [px] from the header, for which the beginning of a file is enough. Returns
/// false if there is none.
bool jpeg_size(const std::string& file, int* width, int* height);

}  // namespace sketchsplat
