// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "datasets/readers/scene.h"
#include "datasets/types/errors.h"
#include "tests/datasets/temp_folder.h"

namespace sketchsplat {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// A camera at (1, 2, 3) that looks along -y of the world: columns right, up, backward.
constexpr char kPose[] = "[[-1,0,0,1],[0,0,1,2],[0,1,0,3],[0,0,0,1]]";
constexpr char kIntrinsics[] = R"("fl_x": 20, "fl_y": 21, "cx": 8.25, "cy": 6.5, "w": 16, "h": 12)";

void write_image(const TempFolder& folder, const std::string& name) {
  write_png(folder.file(name), Image<float>(16, 12, 0.2f));
}

std::string frame(const std::string& name, const std::string& more = "") {
  return R"({"file_path": ")" + name + R"(", "transform_matrix": )" + kPose + more + "}";
}

Scene open(const std::string& top, const std::string& frames) {
  const TempFolder folder;
  write_image(folder, "images/a.png");
  write_image(folder, "images/b.png");
  write_image(folder, "masks/a.png");
  folder.write("transforms.json", "{" + top + R"(, "frames": [)" + frames + "]}");
  return open_scene(folder.path());
}

TEST(Nerfstudio, CamerasHaveOpenGlAxesAndColmapsPixels) {
  const Scene scene = open(std::string(kIntrinsics) +
                               R"(, "camera_model": "OPENCV", "k1": -0.1, "k2": 0.02, "p1": 0.003,
                                  "p2": 0.004, "ply_file_path": "sparse_pc.ply",
                                  "applied_transform": [[0,1,0,7],[1,0,0,8],[0,0,-1,9]])",
                           frame("images/a.png") + "," + frame("./images/b.png"));
  EXPECT_EQ(scene.format, "nerfstudio");
  EXPECT_THAT(scene.warnings, IsEmpty());
  ASSERT_EQ(scene.views.size(), 2u);
  const View& v = scene.views[1];
  EXPECT_EQ(v.name, "b.png");
  EXPECT_EQ(v.camera.width, 16);
  EXPECT_EQ(v.camera.fx, 20);
  EXPECT_EQ(v.camera.fy, 21);
  EXPECT_EQ(v.camera.cx, 7.75);
  EXPECT_EQ(v.camera.cy, 6);
  EXPECT_LT((v.center_in_world() - Eigen::Vector3d(1, 2, 3)).norm(), 1e-12)
      << "transform_matrix is all that counts";
  double depth;
  const Eigen::Vector2d pixel = v.project({1, 1, 3.1}, &depth);  // 1 ahead, 0.1 above the axis
  EXPECT_NEAR(depth, 1, 1e-12);
  EXPECT_NEAR(pixel.y(), 6 - 2.1, 1e-12);
  const Lens::Terms& k = v.lens.terms();
  EXPECT_EQ(k.k1, -0.1);
  EXPECT_EQ(k.k2, 0.02);
  EXPECT_EQ(k.p1, 0.003);
  EXPECT_EQ(k.p2, 0.004);
  EXPECT_TRUE(scene.points.empty());
}

TEST(Nerfstudio, WhatAFrameSaysComesFirst) {
  const Scene scene = open(
      std::string(kIntrinsics) + R"(, "k1": 0.1)",
      frame("images/a.png", R"(, "fl_x": 30, "cx": 9, "k1": 0)") + "," +
          frame("images/b.png", R"(, "camera_model": "OPENCV_FISHEYE", "k1": 0.01, "k4": 0.04)"));
  EXPECT_EQ(scene.views[0].camera.fx, 30);
  EXPECT_EQ(scene.views[0].camera.fy, 21);
  EXPECT_EQ(scene.views[0].camera.cx, 8.5);
  EXPECT_TRUE(scene.views[0].lens.is_identity());
  EXPECT_EQ(scene.views[1].lens.model(), LensModel::kOpencvFisheye);
  EXPECT_EQ(scene.views[1].lens.terms().k1, 0.01);
  EXPECT_EQ(scene.views[1].lens.terms().k4, 0.04);
}

TEST(Nerfstudio, ThirdTermIsOfTheSixthPower) {
  const Scene scene = open(std::string(kIntrinsics) + R"(, "k3": 0.5)", frame("images/a.png"));
  const double r = 0.4;
  EXPECT_NEAR(scene.views[0].lens.distort({r, 0}).x(), r * (1 + 0.5 * std::pow(r, 6)), 1e-15);
}

TEST(Nerfstudio, FieldOfViewAloneCentresTheCameraOnTheImage) {
  const Scene scene = open(R"("camera_angle_x": 1.0)", frame("images/a"));
  const Camera& c = scene.views.at(0).camera;
  EXPECT_EQ(c.width, 16) << "from the image";
  EXPECT_NEAR(c.fx, 8 / std::tan(0.5), 1e-12);
  EXPECT_EQ(c.fy, c.fx);
  EXPECT_EQ(c.cx, 7.5);
  EXPECT_EQ(c.cy, 5.5);
}

TEST(Nerfstudio, MasksAndWhatIsMissingAreNamed) {
  const Scene scene = open(kIntrinsics, frame("images/a.png", R"(, "mask_path": "masks/a.png")") +
                                            "," + frame("images/none.png") + "," +
                                            frame("images/nil", R"(, "mask_path": "masks/b")"));
  ASSERT_EQ(scene.views.size(), 1u);
  EXPECT_THAT(scene.views[0].mask_path, HasSubstr("/masks/a.png"));
  EXPECT_THAT(scene.warnings,
              ElementsAre("poses without an image: 2 (images/none.png, images/nil)",
                          "images without a pose: 1 (images/b.png)",
                          "masks that are missing or outside of the scene: 1 (masks/b)"));
}

std::string complaint(const std::string& top, const std::string& frames = frame("images/a.png")) {
  try {
    open(top, frames);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(Nerfstudio, WhatCannotBeUsedIsNamed) {
  EXPECT_THAT(complaint(R"("w": 16)"), HasSubstr("expected the key \"fl_x\""));
  EXPECT_THAT(complaint(std::string(kIntrinsics) + R"(, "camera_model": "EQUIRECTANGULAR")"),
              AllOf(HasSubstr("colmap image_undistorter"), HasSubstr("found \"EQUIRECTANGULAR\"")));
  EXPECT_THAT(
      complaint(std::string(kIntrinsics) + R"(, "k4": 0.1)"),
      HasSubstr("transforms.json: expected 0 with a camera model that is no fisheye in k4"));
  EXPECT_THAT(complaint(kIntrinsics, R"({"file_path": "images/a.png", "transform_matrix": [[1]]})"),
              HasSubstr("expected a 4 x 4 matrix in frames[0].transform_matrix"));
  EXPECT_THAT(complaint(std::string(kIntrinsics) + R"(, "k1": "much")"),
              HasSubstr("expected a number in k1"));
  EXPECT_THAT(complaint(std::string(kIntrinsics) + R"(, "k1": NaN)"),
              HasSubstr("its distortion is not finite"));
}

TEST(Nerfstudio, OlderFormatsComeBeforeAndColmapAfter) {
  const TempFolder folder;
  write_image(folder, "images/a.png");
  folder.write("sparse/0/cameras.txt", "1 PINHOLE 16 12 20 20 8 6\n");
  folder.write("sparse/0/images.txt", "1 1 0 0 0 0 0 1 1 a.png\n\n");
  EXPECT_EQ(open_scene(folder.path()).format, "colmap");
  folder.write("transforms.json",
               std::string("{") + kIntrinsics + R"(, "frames": [)" + frame("images/a.png") + "]}");
  EXPECT_EQ(open_scene(folder.path()).format, "nerfstudio");
  EXPECT_EQ(open_scene(folder.path(), "colmap").format, "colmap");
  folder.write("transforms_train.json",
               R"({"camera_angle_x": 1, "frames": [)" + frame("images/a.png") + "]}");
  EXPECT_EQ(open_scene(folder.path()).format, "nerf");
}

}  // namespace
}  // namespace sketchsplat
