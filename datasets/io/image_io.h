// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "datasets/types/image.h"

namespace sketchsplat {

// All functions may be called from many threads at once; none starts threads of its own.

/// Reads an image file: 8 or 16 bit grey, grey + alpha, RGB, RGBA -> [0, 1], alpha not
/// premultiplied, samples as stored (no gamma, no rotation by EXIF: models are calibrated on the
/// rows as they lie in the file). PNG is decoded by libpng, JPEG by libturbojpeg; for anything else
/// OpenImageIO is loaded on the first call. A `denominator` above 1 gives a picture so much
/// smaller, rounded up (see Camera::shrunk), for a fraction of the time if it is even and the file
/// is JPEG; blocks are averaged otherwise. Throws InputError if the file is missing, truncated or
/// no image.
Picture read_picture(const std::string& path, int denominator = 1);

/// Reads one grey channel in [0, 1] (mean of the colours, alpha not looked at). Throws InputError.
Image<float> read_grey(const std::string& path, int denominator = 1);

/// Width and height [px] from the header of an image file. Throws InputError.
struct ImageSize {
  int width = 0, height = 0;
};
ImageSize read_image_size(const std::string& path);

/// Writes 8-bit PNG from values in [0, 1] (clamped; NaN is written as 0), whole or not at all:
/// under a temporary name, then renamed. The folder must exist. Throws OutputError.
void write_png(const std::string& path, const Image<float>& grey);
void write_png(const std::string& path, const Picture& picture);  ///< RGB, RGBA if alpha is there

/// Writes the colours of a picture as a JPEG file of that quality, in [1, 100], whose colours have
/// half of the resolution; whole or not at all. The folder must exist. Throws OutputError.
void write_jpeg(const std::string& path, const Picture& picture, int quality);

/// What is left of the colours of a picture after a JPEG file of that quality, in [1, 100], whose
/// colours have half of the resolution; alpha stays as it is.
Picture through_jpeg(const Picture& picture, int quality);

}  // namespace sketchsplat
