// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>
#include <png.h>

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "datasets/io/image_io.h"
#include "datasets/types/errors.h"

namespace sketchsplat::test {

/// Writes samples (8 or 16 bit, interleaved) by libpng, so that reading is not tested against our
/// own writer alone.
inline void write_by_libpng(const std::string& path, int width, int height, int depth,
                            int color_type, const std::vector<uint16_t>& samples,
                            int interlace = PNG_INTERLACE_NONE) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  FILE* file = std::fopen(path.c_str(), "wb");
  ASSERT_TRUE(file);
  png_init_io(png, file);
  png_set_IHDR(png, info, width, height, depth, color_type, interlace, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  if (color_type == PNG_COLOR_TYPE_PALETTE) {
    const png_color palette[2] = {{255, 0, 51}, {0, 102, 204}};
    const png_byte transparency[1] = {51};
    png_set_PLTE(png, info, palette, 2);
    png_set_tRNS(png, info, transparency, 1, nullptr);
  }
  png_set_gAMA(png, info, 1.0);  // must not change what is read
  png_write_info(png, info);
  std::vector<png_byte> bytes;
  for (const uint16_t sample : samples) {
    if (depth == 16) bytes.push_back(sample >> 8);
    bytes.push_back(sample & 255);
  }
  std::vector<png_bytep> rows;
  for (int y = 0; y < height; ++y) rows.push_back(bytes.data() + y * bytes.size() / height);
  png_write_image(png, rows.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  std::fclose(file);
}

/// What read_picture complains of.
inline std::string what_is_found(const std::string& path) {
  try {
    read_picture(path);
  } catch (const InputError& e) {
    return e.what();
  }
  return "an image";
}

}  // namespace sketchsplat::test
