// SPDX-License-Identifier: MIT
#include "datasets/readers/smaller_pictures.h"

#include <gtest/gtest.h>

#include "tests/datasets/temp_folder.h"

namespace sketchsplat {
namespace {

// A picture of 24 x 16 px, black but for a white quarter, with a mask of the right half.
struct Smaller : testing::Test {
  Smaller() {
    Picture p;
    p.red = p.green = p.blue = Image<float>(24, 16, 0.0f);
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 12; ++x) p.red.at(x, y) = p.green.at(x, y) = p.blue.at(x, y) = 1;
    write_png(folder.file("images/a.png"), p);
    Image<float> mask(24, 16, 0.0f);
    for (int y = 0; y < 16; ++y)
      for (int x = 12; x < 24; ++x) mask.at(x, y) = 1;
    write_png(folder.file("masks/a.png"), mask);
    folder.write("sparse/0/cameras.txt", "1 OPENCV 24 16 30 31 12.5 7 -0.1 0.02 0 0\n");
    folder.write("sparse/0/images.txt", "1 1 0 0 0 0 0 1 1 a.png\n\n");
    scene = open_scene(folder.path());
  }
  TempFolder folder;
  Scene scene;
};

TEST_F(Smaller, PixelsOfPointsFollow) {
  scene.points = {{{0, 0, 1}, {{0, {11.5, 3.5}}}}};
  EXPECT_EQ(with_smaller_pictures(scene, 6).points[0].sights[0].pixel, Eigen::Vector2d(2.5, 0.5));
}

TEST_F(Smaller, BlocksOfPixelsBecomeOneAndTheCameraAndMaskFollow) {
  const Scene small = with_smaller_pictures(scene, 6);  // 24 / 6: a fourth
  const View& view = small.views[0];
  EXPECT_EQ(view.camera.width, 6);
  EXPECT_EQ(view.camera.height, 4);
  const Picture p = read_picture(view);
  EXPECT_EQ(p.width(), 6);
  EXPECT_EQ(p.red.at(2, 1), 1);
  EXPECT_EQ(p.red.at(3, 1), 0);
  EXPECT_EQ(p.alpha.at(2, 1), 0);
  EXPECT_EQ(p.alpha.at(3, 1), 1);
  // What was between four pixels is where their block is.
  double depth;
  const Eigen::Vector3d x(0.1, -0.05, 0);
  const Eigen::Vector2d large = scene.views[0].project(x, &depth), at = view.project(x, &depth);
  EXPECT_NEAR(at.x(), (large.x() + 0.5) / 4 - 0.5, 1e-12);
  EXPECT_NEAR(at.y(), (large.y() + 0.5) / 4 - 0.5, 1e-12);
}

TEST_F(Smaller, PicturesThatAreNotTwiceAsLargeStay) {
  for (const int side : {0, 13, 24, 1000}) {
    const Scene same = with_smaller_pictures(scene, side);
    EXPECT_EQ(same.views[0].camera.width, 24) << side;
    EXPECT_FALSE(same.views[0].make_picture) << side;
  }
  EXPECT_EQ(with_smaller_pictures(scene, 12).views[0].camera.width, 12);
}

TEST_F(Smaller, CamerasGoBackToFullSize) {
  Scene small = with_smaller_pictures(scene, 6);
  small.views[0].cam_from_world.translation.x() = 0.25;
  small.views[0].camera.fx *= 1.01;
  const std::vector<View> back = at_full_size(small.views, small, scene);
  const Camera &full = scene.views[0].camera, &now = back[0].camera;
  EXPECT_EQ(now.width, 24);
  EXPECT_EQ(now.height, 16);
  EXPECT_NEAR(now.fx, 1.01 * full.fx, 1e-12);
  EXPECT_NEAR(now.fy, full.fy, 1e-12);
  EXPECT_NEAR(now.cx, full.cx, 1e-12);
  EXPECT_NEAR(now.cy, full.cy, 1e-12);
  EXPECT_EQ(back[0].cam_from_world.translation.x(), 0.25);
  EXPECT_EQ(read_picture(back[0]).width(), 24);
}

TEST_F(Smaller, ViewsThatWereLeftOutAndImagesThatComeTwiceAreNoMatter) {
  scene.views.resize(3, scene.views[0]);
  for (int v = 0; v < 3; ++v) {
    scene.views[v].name = std::to_string(v);
    scene.views[v].camera.fx += v;
  }
  const Scene small = with_smaller_pictures(scene, 6);
  const std::vector<View> back = at_full_size({small.views[0], small.views[2]}, small, scene);
  ASSERT_EQ(back.size(), 2u);
  EXPECT_EQ(back[0].name, "0");
  EXPECT_EQ(back[1].name, "2");
  EXPECT_NEAR(back[1].camera.fx, scene.views[2].camera.fx, 1e-12);
}

}  // namespace
}  // namespace sketchsplat
