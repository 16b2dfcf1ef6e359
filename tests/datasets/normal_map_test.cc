// SPDX-License-Identifier: MIT
#include "datasets/io/normal_map.h"

#include <gtest/gtest.h>

#include "datasets/io/image_io.h"
#include "datasets/types/errors.h"
#include "tests/datasets/temp_folder.h"

namespace sketchsplat {
namespace {

const Camera kCamera{4, 3, 10, 10, 1.5, 1};

Picture painted(float r, float g, float b) {
  Picture p;
  p.red = Image<float>(4, 3, r), p.green = Image<float>(4, 3, g), p.blue = Image<float>(4, 3, b);
  return p;
}

TEST(NormalMap, OfOpenGlAxesBecomesOpenCvAxes) {
  const TempFolder folder;
  // Right, up and towards the viewer.
  write_png(folder.file("n.png"), painted(0.5f + 0.3f, 0.5f + 0.2f, 0.5f + 0.3464f));
  const auto n = read_normal_map(folder.file("n.png"), kCamera);
  EXPECT_NEAR(n[0].at(2, 1), 0.6, 0.01);
  EXPECT_NEAR(n[1].at(2, 1), -0.4, 0.01);
  EXPECT_NEAR(n[2].at(2, 1), -0.693, 0.01);
}

TEST(NormalMap, BlackIsNoNormal) {
  const TempFolder folder;
  Picture p = painted(0.5f, 0.5f, 1);
  p.red.at(0, 0) = p.green.at(0, 0) = p.blue.at(0, 0) = 0;
  write_png(folder.file("n.png"), p);
  const auto n = read_normal_map(folder.file("n.png"), kCamera);
  EXPECT_EQ(n[2].at(0, 0), 0);
  EXPECT_NEAR(n[2].at(1, 0), -1, 0.01);
}

TEST(NormalMap, OfAnotherFrameOrSizeIsRefused) {
  const TempFolder folder;
  write_png(folder.file("n.png"), painted(0.5f, 0.5f, 0));
  EXPECT_THROW(read_normal_map(folder.file("n.png"), kCamera), InputError);
  write_png(folder.file("n.png"), painted(0.5f, 0.5f, 1));
  Camera other = kCamera;
  other.width = 5;
  EXPECT_THROW(read_normal_map(folder.file("n.png"), other), InputError);
}

}  // namespace
}  // namespace sketchsplat
