// SPDX-License-Identifier: MIT
#include "datasets/io/image_io.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <thread>

#include "datasets/types/camera.h"
#include "datasets/types/errors.h"
#include "tests/datasets/image_files.h"
#include "tests/datasets/temp_folder.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using ::testing::ElementsAre;
using ::testing::FloatEq;
using ::testing::HasSubstr;

Image<float> noise(int width, int height) {
  Image<float> image(width, height);
  uint32_t state = 1;
  for (float& v : image.data) {
    state = state * 1664525u + 1013904223u;
    v = float(state >> 24) / 255.0f;
  }
  return image;
}

TEST(ReadPicture, GreyBecomesThreeEqualColoursWithoutAlpha) {
  const TempFolder folder;
  const std::string path = folder.file("grey.png");
  write_by_libpng(path, 2, 1, 8, PNG_COLOR_TYPE_GRAY, {51, 255});
  const Picture p = read_picture(path);
  EXPECT_EQ(p.width(), 2);
  EXPECT_EQ(p.height(), 1);
  EXPECT_THAT(p.red.data, ElementsAre(FloatEq(0.2f), 1.0f));
  EXPECT_EQ(p.green.data, p.red.data);
  EXPECT_EQ(p.blue.data, p.red.data);
  EXPECT_TRUE(p.alpha.empty());
}

TEST(ReadPicture, GreyWithAlphaKeepsBothApart) {
  const TempFolder folder;
  const std::string path = folder.file("grey_alpha.png");
  write_by_libpng(path, 1, 2, 8, PNG_COLOR_TYPE_GRAY_ALPHA, {204, 51, 102, 0});
  const Picture p = read_picture(path);
  EXPECT_THAT(p.blue.data, ElementsAre(FloatEq(0.8f), FloatEq(0.4f)));
  EXPECT_THAT(p.alpha.data, ElementsAre(FloatEq(0.2f), 0.0f));
}

TEST(ReadPicture, RgbKeepsTheOrderOfColoursAndRows) {
  const TempFolder folder;
  const std::string path = folder.file("rgb.png");
  write_by_libpng(path, 1, 2, 8, PNG_COLOR_TYPE_RGB, {51, 102, 153, 255, 0, 204});
  const Picture p = read_picture(path);
  EXPECT_THAT(p.red.data, ElementsAre(FloatEq(0.2f), 1.0f));
  EXPECT_THAT(p.green.data, ElementsAre(FloatEq(0.4f), 0.0f));
  EXPECT_THAT(p.blue.data, ElementsAre(FloatEq(0.6f), FloatEq(0.8f)));
}

TEST(ReadPicture, ColoursAreNotMultipliedByAlpha) {
  const TempFolder folder;
  const std::string path = folder.file("rgba.png");
  write_by_libpng(path, 2, 1, 8, PNG_COLOR_TYPE_RGBA, {204, 153, 255, 51, 255, 102, 51, 0});
  const Picture p = read_picture(path);
  EXPECT_THAT(p.red.data, ElementsAre(FloatEq(0.8f), 1.0f));
  EXPECT_THAT(p.green.data, ElementsAre(FloatEq(0.6f), FloatEq(0.4f)));
  EXPECT_THAT(p.blue.data, ElementsAre(1.0f, FloatEq(0.2f)));
  EXPECT_THAT(p.alpha.data, ElementsAre(FloatEq(0.2f), 0.0f));
}

TEST(ReadPicture, SixteenBitsKeepTheirLowByte) {
  const TempFolder folder;
  const std::string path = folder.file("deep.png");
  write_by_libpng(path, 1, 1, 16, PNG_COLOR_TYPE_RGBA, {0x1234, 0xffff, 0x0001, 0x8000});
  const Picture p = read_picture(path);
  EXPECT_FLOAT_EQ(p.red.at(0, 0), 0x1234 / 65535.0f);
  EXPECT_FLOAT_EQ(p.green.at(0, 0), 1.0f);
  EXPECT_FLOAT_EQ(p.blue.at(0, 0), 1 / 65535.0f);
  EXPECT_FLOAT_EQ(p.alpha.at(0, 0), 0x8000 / 65535.0f);
}

TEST(ReadPicture, PalettesAreExpanded) {
  const TempFolder folder;
  const std::string path = folder.file("palette.png");
  write_by_libpng(path, 2, 1, 8, PNG_COLOR_TYPE_PALETTE, {1, 0});
  const Picture p = read_picture(path);
  EXPECT_THAT(p.red.data, ElementsAre(0.0f, 1.0f));
  EXPECT_THAT(p.blue.data, ElementsAre(FloatEq(0.8f), FloatEq(0.2f)));
  EXPECT_THAT(p.alpha.data, ElementsAre(1.0f, FloatEq(0.2f)));
}

TEST(ReadPicture, InterlacedFilesAreReadAsOthers) {
  const TempFolder folder;
  std::vector<uint16_t> samples;
  for (int i = 0; i < 13 * 11 * 3; ++i) samples.push_back(i * 37 % 256);
  write_by_libpng(folder.file("a.png"), 13, 11, 8, PNG_COLOR_TYPE_RGB, samples);
  write_by_libpng(folder.file("b.png"), 13, 11, 8, PNG_COLOR_TYPE_RGB, samples,
                  PNG_INTERLACE_ADAM7);
  const Picture a = read_picture(folder.file("a.png")), b = read_picture(folder.file("b.png"));
  EXPECT_EQ(a.red.data, b.red.data);
  EXPECT_EQ(a.blue.data, b.blue.data);
  EXPECT_EQ(a.blue.data.size(), 13u * 11u);
}

TEST(ReadPicture, OtherFormatsAreReadByThePlugin) {
  const TempFolder folder;
  const std::string path = folder.write("two words.ppm", "P6\n2 1\n255\n\x33\x66\x99\xff\xcc\x01");
  const Picture p = read_picture(path);
  EXPECT_THAT(p.red.data, ElementsAre(FloatEq(0.2f), 1.0f));
  EXPECT_THAT(p.green.data, ElementsAre(FloatEq(0.4f), FloatEq(0.8f)));
  EXPECT_TRUE(p.alpha.empty());
  EXPECT_EQ(read_image_size(path).width, 2);
  EXPECT_EQ(read_image_size(path).height, 1);
}

/// Uncompressed TIFF, one RGBA pixel. `extra_samples`: 1 premultiplied, 2 not.
std::string tiff_of_one_pixel(int extra_samples, const std::string& rgba) {
  std::string bytes("II*\0\x0c\0\0\0", 8);
  bytes += rgba;  // at 8
  const auto entry = [&](int tag, int type, int count, int value) {
    for (const int v : {tag, type}) bytes += {char(v & 255), char(v >> 8)};
    for (const int v : {count, value}) {
      for (int shift = 0; shift < 32; shift += 8) bytes += char(v >> shift & 255);
    }
  };
  bytes += std::string("\x0b\0", 2);
  entry(256, 3, 1, 1);    // width
  entry(257, 3, 1, 1);    // height
  entry(258, 3, 4, 150);  // bits per sample: offset of four values
  entry(259, 3, 1, 1);    // no compression
  entry(262, 3, 1, 2);    // RGB
  entry(273, 4, 1, 8);    // offset of the strip
  entry(277, 3, 1, 4);    // samples per pixel
  entry(278, 3, 1, 1);    // rows per strip
  entry(279, 4, 1, 4);    // bytes of the strip
  entry(284, 3, 1, 1);    // interleaved
  entry(338, 3, 1, extra_samples);
  bytes += std::string(4, '\0');
  return bytes + std::string("\x08\0\x08\0\x08\0\x08\0", 8);
}

TEST(ReadPicture, PremultipliedFilesAreDividedByAlphaAndOthersAreNot) {
  const TempFolder folder;
  const std::string associated =
      folder.write("associated.tif", tiff_of_one_pixel(1, "\x28\x14\x33\x33"));
  EXPECT_NEAR(read_picture(associated).red.at(0, 0), 40 / 51.0, 1e-6);
  EXPECT_NEAR(read_picture(associated).blue.at(0, 0), 1.0, 1e-6);
  EXPECT_NEAR(read_picture(associated).alpha.at(0, 0), 0.2, 1e-6);
  const std::string straight =
      folder.write("straight.tif", tiff_of_one_pixel(2, "\x28\x14\x33\x33"));
  EXPECT_NEAR(read_picture(straight).red.at(0, 0), 40 / 255.0, 1e-6);
  const std::string impossible =
      folder.write("impossible.tif", tiff_of_one_pixel(1, "\xcc\x14\x33\x33"));
  EXPECT_NEAR(read_picture(impossible).red.at(0, 0), 0.8, 1e-6)
      << "a colour above alpha cannot be premultiplied";
}

// Uncompressed, 24 bits.
std::string tga_of_one_pixel() {
  std::string bytes(18, '\0');
  bytes[2] = 2, bytes[12] = 1, bytes[14] = 1, bytes[16] = 24;
  return bytes + "\x33\x66\x99";
}

// What a file is called says little, and a broken one is its own format's business alone.
TEST(ReadPicture, FormatsAreToldByTheirFirstBytes) {
  const TempFolder folder;
  const std::string tiff = tiff_of_one_pixel(2, "\x33\x66\x99\x80");
  for (const char* name : {"a.tif", "a.png", "a.bmp", "a"}) {
    const Picture p = read_picture(folder.write(name, tiff));
    EXPECT_THAT(p.red.data, ElementsAre(FloatEq(0.2f))) << name;
    EXPECT_EQ(read_image_size(folder.file(name)).width, 1) << name;
  }
  const std::string ppm = "P6\n1 1\n255\n\x33\x66\x99", tga = tga_of_one_pixel();
  for (const char* name : {"a.ppm", "A.PPM", "a.img", "b"})
    EXPECT_EQ(read_image_size(folder.write(name, ppm)).width, 1) << name;
  for (const char* name : {"a.tga", "A.TGA"})  // has no such bytes
    EXPECT_EQ(read_image_size(folder.write(name, tga)).width, 1) << name;
  EXPECT_THAT(what_is_found(folder.write("c", tga)), HasSubstr("a known format"));
  EXPECT_THAT(what_is_found(folder.write("c.img", tga)), HasSubstr("a known format"));
  EXPECT_THAT(what_is_found(folder.write("b.bmp", tiff.substr(0, 20))), HasSubstr("directory"));
  EXPECT_THROW(read_picture(folder.write("c.tif", "BM" + tiff)), InputError);
}

TEST(ReadPicture, TruncatedPngIsRefusedWhereverItIsCut) {
  const TempFolder folder;
  const std::string whole = folder.file("whole.png");
  write_png(whole, noise(64, 48));
  const std::string bytes = bytes_of(whole);
  for (const size_t size : {size_t(1), size_t(7), size_t(8), size_t(20), size_t(33), size_t(40),
                            bytes.size() / 2, bytes.size() - 12, bytes.size() - 1}) {
    const std::string cut = folder.write("cut.png", bytes.substr(0, size));
    EXPECT_THAT(what_is_found(cut), HasSubstr("cut.png: expected a")) << size << " bytes";
    EXPECT_THROW(read_grey(cut), InputError) << size << " bytes";
  }
}

TEST(ReadPicture, PngWithAFlippedBitIsRefused) {
  const TempFolder folder;
  write_png(folder.file("whole.png"), noise(64, 48));
  std::string bytes = bytes_of(folder.file("whole.png"));
  bytes[bytes.size() / 2] ^= 1;
  EXPECT_THAT(what_is_found(folder.write("flipped.png", bytes)), HasSubstr("a broken one"));
}

TEST(ReadPicture, HeaderThatPromisesTooMuchIsRefusedBeforeMemoryIsTaken) {
  const TempFolder folder;
  const std::string path = folder.file("huge.png");
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  FILE* file = std::fopen(path.c_str(), "wb");
  png_init_io(png, file);
  png_set_IHDR(png, info, 900000, 900000, 8, PNG_COLOR_TYPE_RGBA, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  std::vector<png_byte> nothing(64);
  png_byte name[] = "IDAT";
  png_write_chunk(png, name, nothing.data(), nothing.size());
  png_destroy_write_struct(&png, &info);
  std::fclose(file);
  EXPECT_THAT(what_is_found(path), HasSubstr("more pixels than the file can hold"));
}

TEST(ReadPicture, WhatIsNoImageIsNamed) {
  const TempFolder folder;
  EXPECT_THAT(what_is_found(folder.write("empty.png", "")), HasSubstr("found an empty file"));
  EXPECT_THAT(what_is_found(folder.path()), HasSubstr("found a directory"));
  EXPECT_THAT(what_is_found(folder.file("none.png")), HasSubstr("found No such file"));
  const std::string text = what_is_found(folder.write("text.png", "once upon a time\n"));
  EXPECT_THAT(text, HasSubstr("text.png: expected an image, found "));
  EXPECT_EQ(text.find('\n'), std::string::npos);
  EXPECT_THROW(read_image_size(folder.file("text.png")), InputError);
  EXPECT_THROW(read_image_size(folder.write("short.png", "\x89PNG\r\n\x1a\n")), InputError);
}

TEST(ReadPicture, ThreadsDoNotDisturbOneAnother) {
  const TempFolder folder;
  std::vector<std::string> paths;
  std::vector<Image<float>> written;
  for (int i = 0; i < 8; ++i) {
    written.push_back(noise(31 + i, 17 + i));
    paths.push_back(folder.file(std::to_string(i) + ".png"));
    write_png(paths.back(), written.back());
  }
  std::vector<int> wrong(8, 0);
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&, t] {
      for (int k = 0; k < 40; ++k) {
        const int i = (t + k) % 8;
        wrong[t] += read_picture(paths[i]).green.data != written[i].data;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, std::vector<int>(8, 0));
}

TEST(ReadGrey, IsTheMeanOfTheColours) {
  const TempFolder folder;
  const std::string path = folder.file("rgba.png");
  write_by_libpng(path, 1, 1, 8, PNG_COLOR_TYPE_RGBA, {30, 60, 120, 10});
  EXPECT_FLOAT_EQ(read_grey(path).at(0, 0), 70 / 255.0f);
  write_by_libpng(path, 1, 1, 8, PNG_COLOR_TYPE_GRAY_ALPHA, {51, 10});
  EXPECT_FLOAT_EQ(read_grey(path).at(0, 0), 0.2f);
}

TEST(ReadImageSize, ComesFromTheHeader) {
  const TempFolder folder;
  const std::string path = folder.file("a b.png");
  write_png(path, noise(300, 7));
  EXPECT_EQ(read_image_size(path).width, 300);
  EXPECT_EQ(read_image_size(path).height, 7);
}

TEST(WritePng, EightBitValuesComeBackAsTheyWere) {
  const TempFolder folder;
  Picture p;
  p.red = noise(50, 40);
  p.green = Image<float>(50, 40, 0.2f);
  p.blue = p.red;
  p.blue.data[0] = 0.6f;
  const std::string path = folder.file("name with spaces.png");
  write_png(path, p);
  EXPECT_TRUE(read_picture(path).alpha.empty());
  p.alpha = noise(50, 40);
  write_png(path, p);  // replaces
  const Picture q = read_picture(path);
  EXPECT_EQ(q.red.data, p.red.data);
  EXPECT_EQ(q.green.data, p.green.data);
  EXPECT_EQ(q.blue.data, p.blue.data);
  EXPECT_EQ(q.alpha.data, p.alpha.data);
  write_png(path, p.red);
  EXPECT_EQ(read_grey(path).data, p.red.data);
}

TEST(WritePng, ValuesOutOfRangeAreClampedAndNanIsBlack) {
  const TempFolder folder;
  Image<float> image(5, 1);
  image.data = {-1.0f, 2.0f, std::numeric_limits<float>::quiet_NaN(),
                std::numeric_limits<float>::infinity(), 0.5f};
  write_png(folder.file("a.png"), image);
  EXPECT_THAT(read_grey(folder.file("a.png")).data,
              ElementsAre(0.0f, 1.0f, 0.0f, 1.0f, FloatEq(128 / 255.0f)));
}

TEST(WritePng, LeavesNothingButTheFile) {
  const TempFolder folder;
  write_png(folder.file("a.png"), noise(5, 5));
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    EXPECT_EQ(entry.path().filename(), "a.png");
    ++files;
  }
  EXPECT_EQ(files, 1);
}

TEST(WritePng, WhatCannotBeWrittenIsAnOutputError) {
  const TempFolder folder;
  EXPECT_THROW(write_png(folder.path() + "/none/a.png", noise(5, 5)), OutputError);
  EXPECT_THROW(write_png(folder.file("empty.png"), Image<float>()), OutputError);
  std::filesystem::create_directories(folder.file("full/x"));
  EXPECT_THROW(write_png(folder.path() + "/full", noise(5, 5)), OutputError);
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    EXPECT_EQ(entry.path().filename(), "full") << "a temporary file was left behind";
  }
}

}  // namespace
}  // namespace sketchsplat
