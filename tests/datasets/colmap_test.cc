// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <fstream>

#include "datasets/readers/colmap_write.h"
#include "datasets/readers/scene.h"
#include "datasets/types/errors.h"
#include "tests/datasets/colmap_scene.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<int> views_of(const ScenePoint& point) {
  std::vector<int> views;
  for (const PointSight& sight : point.sights) views.push_back(sight.view);
  return views;
}

void expect_small_model(const Scene& scene) {
  EXPECT_EQ(scene.format, "colmap");
  EXPECT_THAT(scene.warnings, IsEmpty());
  ASSERT_EQ(scene.views.size(), 3u);
  EXPECT_EQ(scene.views[0].name, "b.png") << "in the order of ids";
  EXPECT_EQ(scene.views[1].name, "c.png");
  const View& v = scene.views[2];
  EXPECT_EQ(v.name, "two words.png");
  EXPECT_EQ(v.camera.fx, 20);
  EXPECT_EQ(v.camera.fy, 21);
  EXPECT_EQ(v.camera.cx, 7.75) << "the top-left pixel's centre is (0, 0) here";
  EXPECT_EQ(v.camera.cy, 6);
  EXPECT_EQ(v.lens.model(), LensModel::kOpencv);
  EXPECT_EQ(v.lens.terms().k1, -0.1);
  EXPECT_EQ(v.lens.terms().k2, 0.02);
  EXPECT_EQ(v.lens.terms().p1, 0.001);
  EXPECT_EQ(v.lens.terms().p2, -0.002);
  EXPECT_LT((v.center_in_world() - Eigen::Vector3d(1, -5, 2)).norm(), 1e-12);
  double depth;
  v.project({1, 0, 2}, &depth);
  EXPECT_NEAR(depth, 5, 1e-12);
  EXPECT_TRUE(scene.views[0].lens.is_identity());
  EXPECT_EQ(scene.views[0].camera.fy, 25);
  EXPECT_EQ(scene.views[0].cam_from_world.rotation, Eigen::Matrix3d(Eigen::Matrix3d::Identity()))
      << "a quaternion of any length";
  ASSERT_EQ(scene.points.size(), 2u);
  EXPECT_EQ(scene.points[0].position, Eigen::Vector3d(1, 2, 3));
  EXPECT_THAT(views_of(scene.points[0]), ElementsAre(0, 2));
  EXPECT_THAT(views_of(scene.points[1]), ElementsAre(1));
  EXPECT_FALSE(scene.points[0].sights[0].pixel.allFinite()) << "the image lists no such feature";
  EXPECT_EQ(scene.points[0].sights[1].pixel, Eigen::Vector2d(2.5, 3.5));
}

TEST(Colmap, TextAndBinaryModelsAreReadInAllTheirPlaces) {
  for (const char* place : {"/sparse/0", "/sparse", ""})
    for (const bool binary : {false, true}) {
      const TempFolder folder;
      write_images(folder);
      (binary ? write_colmap_binary : write_colmap_text)(small_model(), folder.path() + place);
      expect_small_model(open_scene(folder.path()));
    }
}

TEST(Colmap, ImagesMayLieBesideTheModel) {
  const TempFolder folder;
  for (const char* name : {"sub/two words.png", "b.png", "c.png"}) write_image(folder, name);
  write_colmap_text(small_model(), folder.path());
  expect_small_model(open_scene(folder.path()));
}

TEST(Colmap, BinaryFilesComeBeforeTextFiles) {
  const TempFolder folder;
  write_images(folder);
  write_colmap_binary(small_model(), folder.path() + "/sparse/0");
  ColmapFiles other = small_model();
  other.images.resize(1);
  write_colmap_text(other, folder.path() + "/sparse/0");
  expect_small_model(open_scene(folder.path()));
}

TEST(Colmap, RigsAndFramesOfNewerVersionsChangeNothing) {
  const TempFolder folder;
  write_images(folder);
  write_colmap_binary(small_model(), folder.path() + "/sparse/0");
  folder.write("sparse/0/rigs.bin", "whatever");
  folder.write("sparse/0/frames.bin", "whatever");
  expect_small_model(open_scene(folder.path()));
}

TEST(Colmap, WhatIsWrittenIsReadAgain) {
  const TempFolder folder;
  write_colmap_text(small_model(), folder.path() + "/sparse");
  write_images(folder);
  const Scene scene = open_scene(folder.path());
  std::vector<View> views = scene.views;
  views[2].name = "sub/" + views[2].name;
  const ColmapText text = colmap_text(views);
  std::ofstream(folder.file("sparse/cameras.txt")) << text.cameras;
  std::ofstream(folder.file("sparse/images.txt")) << text.images;
  std::ofstream(folder.file("sparse/points3D.txt")) << text.points;
  const Scene again = open_scene(folder.path());
  ASSERT_EQ(again.views.size(), 3u);
  EXPECT_THAT(shared_cameras(again.views), ElementsAre(0, 0, 1));
  for (int v = 0; v < 3; ++v) {
    const View &a = scene.views[v], &b = again.views[v];
    EXPECT_EQ(b.name, a.name);
    EXPECT_EQ(b.camera.fx, a.camera.fx);
    EXPECT_EQ(b.camera.fy, a.camera.fy);
    EXPECT_EQ(b.camera.cx, a.camera.cx);
    EXPECT_EQ(b.camera.cy, a.camera.cy);
    EXPECT_EQ(b.lens.model(), a.lens.model());
    EXPECT_EQ(b.lens.terms().p2, a.lens.terms().p2);
    EXPECT_LT((b.cam_from_world.rotation - a.cam_from_world.rotation).norm(), 1e-14);
    EXPECT_LT((b.cam_from_world.translation - a.cam_from_world.translation).norm(), 1e-14);
  }
}

TEST(Colmap, WindowsLineEndsAreRead) {
  const TempFolder folder;
  write_images(folder);
  write_colmap_text(small_model(), folder.path() + "/sparse");
  for (const char* name : {"sparse/cameras.txt", "sparse/images.txt", "sparse/points3D.txt"}) {
    std::string text = bytes_of(folder.file(name));
    for (size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2)
      text.insert(at, "\r");
    folder.write(name, text);
  }
  expect_small_model(open_scene(folder.path()));
}

Lens lens_read(const std::string& model, int id, const std::vector<double>& parameters,
               Camera* camera = nullptr) {
  std::vector<Lens> lenses;
  for (const bool binary : {false, true}) {
    const TempFolder folder;
    write_image(folder, "images/a.png");
    ColmapFiles m;
    m.cameras = {{1, model, id, 16, 12, parameters}};
    m.images = {{1, {1, 0, 0, 0}, {0, 0, 1}, 1, "a.png"}};
    (binary ? write_colmap_binary : write_colmap_text)(m, folder.path() + "/sparse/0");
    const View view = open_scene(folder.path()).views.at(0);
    lenses.push_back(view.lens);
    if (camera) *camera = view.camera;
  }
  EXPECT_EQ(lenses[0].model(), lenses[1].model());
  const Eigen::Vector2d p(0.21, -0.32);
  EXPECT_EQ(lenses[0].distort(p), lenses[1].distort(p));
  return lenses[1];
}

TEST(Colmap, ParametersOfEveryModelAreInItsOrder) {
  Camera camera;
  EXPECT_TRUE(lens_read("PINHOLE", 1, {30, 31, 8, 7}, &camera).is_identity());
  EXPECT_EQ(camera.fx, 30);
  EXPECT_EQ(camera.fy, 31);
  EXPECT_EQ(camera.cy, 6.5);
  EXPECT_EQ(lens_read("SIMPLE_RADIAL", 2, {30, 8, 7, 0.1}, &camera).terms().k1, 0.1);
  EXPECT_EQ(camera.fy, 30);
  EXPECT_EQ(camera.cx, 7.5);
  const Lens radial = lens_read("RADIAL", 3, {30, 8, 7, 0.1, 0.2});
  EXPECT_EQ(radial.terms().k1, 0.1);
  EXPECT_EQ(radial.terms().k2, 0.2);
  const Lens::Terms full =
      lens_read("FULL_OPENCV", 6, {30, 31, 8, 7, .1, .2, .3, .4, .5, .6, .7, .8}).terms();
  EXPECT_EQ(full.k1, .1);
  EXPECT_EQ(full.k2, .2);
  EXPECT_EQ(full.p1, .3);
  EXPECT_EQ(full.p2, .4);
  EXPECT_EQ(full.k3, .5);
  EXPECT_EQ(full.k4, .6);
  EXPECT_EQ(full.k5, .7);
  EXPECT_EQ(full.k6, .8);
  const Lens fisheye = lens_read("OPENCV_FISHEYE", 5, {30, 31, 8, 7, .01, .02, .03, .04});
  EXPECT_EQ(fisheye.model(), LensModel::kOpencvFisheye);
  EXPECT_EQ(fisheye.terms().k3, .03);
  EXPECT_EQ(fisheye.terms().k4, .04);
  EXPECT_EQ(fisheye.terms().p1, 0);
}

TEST(Colmap, OfSeveralModelsTheOneWithMostImagesIsTakenAndSaidSo) {
  for (const bool binary : {false, true}) {
    const TempFolder folder;
    write_images(folder);
    const auto write = binary ? write_colmap_binary : write_colmap_text;
    ColmapFiles less = small_model();
    less.images.resize(1);
    write(less, folder.path() + "/sparse/0");
    write(less, folder.path() + "/sparse/2");
    write(small_model(), folder.path() + "/sparse/10");
    const Scene scene = open_scene(folder.path());
    EXPECT_EQ(scene.views.size(), 3u);
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_THAT(scene.warnings[0],
                AllOf(HasSubstr("3 models"), HasSubstr("sparse/10 is used"), HasSubstr("(3)")));
  }
}

TEST(Colmap, PosesWithoutImageAndImagesWithoutPoseAreCountedAndNamed) {
  const TempFolder folder;
  write_image(folder, "images/b.png");
  for (const char* name : {"w", "x", "y", "z"})
    write_image(folder, std::string("images/more/") + name + ".JPG");
  folder.write("images/notes.txt", "no image");
  write_colmap_text(small_model(), folder.path() + "/sparse/0");
  const Scene scene = open_scene(folder.path());
  EXPECT_EQ(scene.views.size(), 1u);
  EXPECT_THAT(scene.warnings,
              ElementsAre("poses without an image: 2 (c.png, sub/two words.png)",
                          "images without a pose: 4 (more/w.JPG, more/x.JPG, more/y.JPG, ...)"));
  ASSERT_EQ(scene.points.size(), 1u) << "points that nobody sees are of no use";
  EXPECT_THAT(views_of(scene.points[0]), ElementsAre(0));
}

TEST(Colmap, PointsMayBeMissingEmptyOrNotFinite) {
  const TempFolder folder;
  write_images(folder);
  ColmapFiles m = small_model();
  m.points[0].position[1] = NAN;
  write_colmap_text(m, folder.path() + "/sparse/0");
  EXPECT_EQ(open_scene(folder.path()).points.size(), 1u);
  m.points.clear();
  write_colmap_text(m, folder.path() + "/sparse/0");
  EXPECT_EQ(open_scene(folder.path()).points.size(), 0u);
  std::filesystem::remove(folder.file("sparse/0/points3D.txt"));
  EXPECT_EQ(open_scene(folder.path()).views.size(), 3u);
}

TEST(Colmap, FramesThatCannotBeUsedAreNamed) {
  for (const bool binary : {false, true}) {
    const TempFolder folder;
    write_images(folder);
    ColmapFiles m = small_model();
    m.images[0].q = {0, 0, 0, 0};
    m.images[1].t[2] = NAN;
    (binary ? write_colmap_binary : write_colmap_text)(m, folder.path() + "/sparse/0");
    const Scene scene = open_scene(folder.path());
    EXPECT_EQ(scene.views.size(), 1u);
    EXPECT_THAT(scene.warnings,
                ElementsAre("frame b.png is left out: its pose is not finite",
                            "frame sub/two words.png is left out: its pose is no rotation"));
  }
}

TEST(Colmap, ALensThatIsNotFiniteIsNoLens) {
  const TempFolder folder;
  write_images(folder);
  ColmapFiles m = small_model();
  m.cameras[0].parameters[5] = INFINITY;
  write_colmap_binary(m, folder.path() + "/sparse/0");
  EXPECT_THAT(open_scene(folder.path()).warnings,
              ElementsAre("frame sub/two words.png is left out: its distortion is not finite"));
}

TEST(Colmap, MasksAreFoundByTheImagesNames) {
  const TempFolder folder;
  write_images(folder);
  write_image(folder, "masks/sub/two words.png");
  write_image(folder, "masks/b.png.png");
  write_colmap_text(small_model(), folder.path() + "/sparse/0");
  const Scene scene = open_scene(folder.path());
  EXPECT_THAT(scene.warnings, IsEmpty()) << "masks are no images without a pose";
  EXPECT_EQ(scene.views[0].mask_path, folder.path() + "/masks/b.png.png");
  EXPECT_EQ(scene.views[1].mask_path, "");
  EXPECT_EQ(scene.views[2].mask_path, folder.path() + "/masks/sub/two words.png");
}

}  // namespace
}  // namespace sketchsplat
