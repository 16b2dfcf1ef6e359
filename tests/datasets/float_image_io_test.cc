// SPDX-License-Identifier: MIT
#include "datasets/io/float_image_io.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "datasets/types/errors.h"
#include "tests/datasets/temp_folder.h"

namespace sketchsplat {
namespace {

Image<float> ramp(int width, int height, float low, float step) {
  Image<float> image(width, height);
  for (size_t i = 0; i < image.data.size(); ++i) image.data[i] = low + step * float(i);
  return image;
}

TEST(Exr, FloatsComeBackAsTheyWereWhateverTheirRange) {
  const TempFolder folder;
  Image<float> depth = ramp(37, 21, -3.7f, 0.1f);
  depth.at(3, 4) = 1e30f;
  depth.at(4, 4) = std::numeric_limits<float>::infinity();
  write_exr(folder.file("depth.exr"), {{"Z", depth}}, false);
  const auto back = read_exr(folder.file("depth.exr"));
  ASSERT_EQ(back.size(), 1u);
  EXPECT_EQ(back[0].name, "Z");
  EXPECT_EQ(back[0].values.width, 37);
  EXPECT_EQ(back[0].values.height, 21);
  EXPECT_EQ(back[0].values.data, depth.data);
}

TEST(Exr, HalvesKeepTheOrderOfChannelsAndElevenBits) {
  const TempFolder folder;
  const Image<float> x = ramp(16, 8, -1.0f, 0.01f), y = ramp(16, 8, 0.0f, 0.002f),
                     z = ramp(16, 8, 1.0f, -0.005f);
  write_exr(folder.file("normal.exr"), {{"R", x}, {"G", y}, {"B", z}}, true);
  const auto back = read_exr(folder.file("normal.exr"));
  ASSERT_EQ(back.size(), 3u);
  const Image<float>* expected[] = {&x, &y, &z};
  const char* names[] = {"R", "G", "B"};
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(back[c].name, names[c]);
    for (size_t i = 0; i < x.data.size(); ++i)
      EXPECT_NEAR(back[c].values.data[i], expected[c]->data[i],
                  std::abs(expected[c]->data[i]) / 2048 + 1e-7);
  }
}

TEST(Exr, WhatCannotBeReadOrWrittenIsSaidAndLeavesNothing) {
  const TempFolder folder;
  EXPECT_THROW(read_exr(folder.path() + "/nothing.exr"), InputError);
  EXPECT_THROW(read_exr(folder.write("text.exr", "no picture")), InputError);
  EXPECT_THROW(write_exr(folder.path() + "/no/depth.exr", {{"Z", ramp(4, 4, 0, 1)}}, false),
               OutputError);
}

// A name in the header says that it is 2 GB long: OpenEXR would take them before it reads.
TEST(Exr, AHeaderThatClaimsMoreThanTheFileHasIsRefusedBeforeMemoryIsTaken) {
  const TempFolder folder;
  const std::string path = folder.file("depth.exr");
  write_exr(path, {{"Z", ramp(8, 8, 0, 1)}}, false);
  const std::string bytes = bytes_of(path);
  const std::string attribute("capDate\0string\0", 15);
  const size_t at = bytes.find(attribute);
  ASSERT_NE(at, std::string::npos);
  const auto refused = [&](const std::string& size) {
    std::string claims = bytes;
    claims.replace(at + attribute.size(), 4, size);
    try {
      read_exr(folder.write("claims.exr", claims));
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_EQ(refused(std::string("\x13\0\0\0", 4)), "");  // as it was
  EXPECT_THAT(refused(std::string("\0\0\0\x7f", 4)), testing::HasSubstr("claims more than"));
  EXPECT_THAT(refused("\xff\xff\xff\xff"), testing::HasSubstr("claims more than"));
}

}  // namespace
}  // namespace sketchsplat
