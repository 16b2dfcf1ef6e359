// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <turbojpeg.h>

#include <cmath>
#include <cstdint>

#include "datasets/io/image_io.h"
#include "datasets/types/camera.h"
#include "tests/datasets/image_files.h"
#include "tests/datasets/temp_folder.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using ::testing::HasSubstr;

TEST(Jpeg, JpegWithoutItsEndIsRefused) {
  const TempFolder folder;
  const std::string path =
      folder.write("cut.jpg", "\xff\xd8\xff\xe0 \xff\xd9 thumbnail \xff\xda 123");
  EXPECT_THAT(what_is_found(path), HasSubstr("a broken one (no end)"));
}

// At the best quality and without sparing colours.
std::string jpeg_of(int width, int height, const std::vector<unsigned char>& samples) {
  const bool grey = int(samples.size()) == width * height;
  const tjhandle codec = tjInitCompress();
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  EXPECT_EQ(tjCompress2(codec, samples.data(), width, 0, height, grey ? TJPF_GRAY : TJPF_RGB,
                        &bytes, &size, grey ? TJSAMP_GRAY : TJSAMP_444, 100, TJFLAG_ACCURATEDCT),
            0);
  const std::string out(reinterpret_cast<char*>(bytes), size);
  tjFree(bytes);
  tjDestroy(codec);
  return out;
}

// A ramp to the right in red, downwards in green.
std::vector<unsigned char> ramps(int width, int height) {
  std::vector<unsigned char> rgb;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (const int v : {20 + 2 * x, 30 + 3 * y, 90}) rgb.push_back(static_cast<unsigned char>(v));
  return rgb;
}

TEST(Jpeg, JpegIsDecodedInColourAndInGrey) {
  const TempFolder folder;
  const std::string path = folder.write("a b.JPG", jpeg_of(61, 43, ramps(61, 43)));
  const Picture p = read_picture(path);
  ASSERT_EQ(p.width(), 61);
  ASSERT_EQ(p.height(), 43);
  EXPECT_TRUE(p.alpha.empty());
  for (int y = 0; y < 43; ++y)
    for (int x = 0; x < 61; ++x) {
      ASSERT_NEAR(p.red.at(x, y), (20 + 2 * x) / 255.0, 3 / 255.0);
      ASSERT_NEAR(p.green.at(x, y), (30 + 3 * y) / 255.0, 3 / 255.0);
      ASSERT_NEAR(p.blue.at(x, y), 90 / 255.0, 4 / 255.0);
    }
  EXPECT_EQ(read_image_size(path).width, 61);
  EXPECT_EQ(read_image_size(path).height, 43);
  const std::string grey = folder.write("g.jpg", jpeg_of(8, 8, std::vector<unsigned char>(64, 51)));
  EXPECT_NEAR(read_picture(grey).blue.at(5, 5), 0.2, 1e-6);
}

TEST(Jpeg, AFractionOfTheSizeShowsTheMeanOfBlocksAtTheShrunkCamera) {
  const TempFolder folder;
  const std::vector<unsigned char> rgb = ramps(61, 43);
  std::vector<uint16_t> samples(rgb.begin(), rgb.end());
  const std::string jpeg = folder.write("a.jpg", jpeg_of(61, 43, rgb)), png = folder.file("a.png");
  write_by_libpng(png, 61, 43, 8, PNG_COLOR_TYPE_RGB, samples);
  for (const int d : {2, 3, 4, 6, 8, 16})
    for (const std::string& path : {jpeg, png}) {
      const Picture p = read_picture(path, d);
      const Camera camera = Camera{61, 43, 50, 50, 30, 21}.shrunk(d);
      ASSERT_EQ(p.width(), camera.width) << path << " " << d;
      ASSERT_EQ(p.height(), camera.height);
      ASSERT_EQ(p.width(), (61 + d - 1) / d);
      for (int y = 1; y < 43 / d - 1; ++y)
        for (int x = 1; x < 61 / d - 1; ++x) {
          // The full pixel whose ray goes through the middle of this one.
          const double u = (x - camera.cx) / camera.fx * 50 + 30;
          const double v = (y - camera.cy) / camera.fy * 50 + 21;
          ASSERT_NEAR(p.red.at(x, y), (20 + 2 * u) / 255, 3 / 255.0) << path << " " << d;
          ASSERT_NEAR(p.green.at(x, y), (30 + 3 * v) / 255, 3 / 255.0) << path << " " << d;
        }
    }
  write_by_libpng(png, 2, 1, 8, PNG_COLOR_TYPE_RGBA, {255, 0, 0, 255, 0, 0, 0, 0});
  const Picture p = read_picture(png, 2);
  EXPECT_FLOAT_EQ(p.alpha.at(0, 0), 0.5f);
  EXPECT_FLOAT_EQ(p.red.at(0, 0), 1) << "what is transparent has no colour";
}

TEST(Jpeg, TruncatedJpegIsRefusedWhereverItIsCut) {
  const TempFolder folder;
  const std::string bytes = jpeg_of(61, 43, ramps(61, 43));
  for (const size_t size : {size_t(3), size_t(20), size_t(200), bytes.size() / 2, bytes.size() - 2})
    for (const std::string end : {"", "\xff\xd9"}) {
      const std::string cut = folder.write("cut.jpg", bytes.substr(0, size) + end);
      if (size == bytes.size() - 2 && !end.empty()) continue;  // that is the whole file
      EXPECT_THAT(what_is_found(cut), HasSubstr("cut.jpg: expected a whole JPEG image, found"))
          << size << " bytes";
    }
}

TEST(Jpeg, JpegHeaderThatPromisesTooMuchIsRefusedBeforeMemoryIsTaken) {
  const TempFolder folder;
  std::string bytes = jpeg_of(16, 16, ramps(16, 16));
  const size_t frame = bytes.find("\xff\xc0");
  ASSERT_NE(frame, std::string::npos);
  bytes.replace(frame + 5, 4, "\xfd\xe8\xfd\xe8");  // 65000 x 65000
  EXPECT_THAT(what_is_found(folder.write("huge.jpg", bytes)),
              HasSubstr("more pixels than the file can hold"));
}

TEST(Jpeg, LowerQualityLosesMoreAndAlphaNothing) {
  Picture picture;
  picture.red = Image<float>(64, 64, 0.2f);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      if (3 * x > y + 60) picture.red.at(x, y) = 0.8f;
  picture.green = picture.blue = picture.alpha = picture.red;
  const auto loss = [&](int quality) {
    const Picture out = through_jpeg(picture, quality);
    EXPECT_EQ(out.alpha.data, picture.alpha.data);
    double sum = 0;
    for (size_t i = 0; i < out.red.data.size(); ++i)
      sum += std::pow(out.red.data[i] - picture.red.data[i], 2);
    return std::sqrt(sum / double(out.red.data.size()));
  };
  const double best = loss(100), good = loss(80), bad = loss(10);
  EXPECT_LT(best, 0.005);
  EXPECT_LT(1.5 * best, good);
  EXPECT_LT(1.5 * good, bad);
}

// Cameras write them between segments; what is missing counts, not what is too much.
TEST(Jpeg, BytesTooManyDoNoHarm) {
  const TempFolder folder;
  const std::string bytes = jpeg_of(61, 43, ramps(61, 43));
  const size_t scan = bytes.find("\xff\xda");
  ASSERT_NE(scan, std::string::npos);
  const std::string whole = folder.write("whole.jpg", bytes);
  const std::string more =
      folder.write("more.jpg", bytes.substr(0, scan) + "abc" + bytes.substr(scan));
  EXPECT_EQ(read_picture(more).red.data, read_picture(whole).red.data);
}

}  // namespace
}  // namespace sketchsplat
