// SPDX-License-Identifier: MIT
// The models that are written beside photographs, against the scene.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "datasets/readers/scene.h"
#include "datasets/truth/ground_truth.h"
#include "tests/datasets/temp_folder.h"
#include "tests/synthetic/small_photographs.h"

namespace sketchsplat {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;
using test::small;

TEST(PhotographModels, ModelIsReadBackAsItIs) {
  const TempFolder folder;
  SynthesizeOptions options = small();
  options.extent = 40;
  options.rig.views = 8;
  options.rig.resolution = 128;
  const SyntheticScene scene = synthesize(options);
  write_scene(scene, folder.path());
  const Scene read = open_scene(folder.path());
  EXPECT_EQ(read.format, "colmap");
  EXPECT_TRUE(read.warnings.empty());
  ASSERT_EQ(read.views.size(), 8u);
  EXPECT_GT(read.points.size(), 200u);
  for (size_t k = 0; k < read.views.size(); ++k) {
    const View &a = scene.views[k], &b = read.views[k];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(b.camera.width, 128);
    EXPECT_EQ(b.camera.height, 96);
    for (const Vector3d& p : {Vector3d(0, 0, 0), Vector3d(40, 40, 40), Vector3d(5, 30, 10)}) {
      double depth;
      Vector2d pa, pb;
      ASSERT_TRUE(a.image_pixel(a.project(p, &depth), &pa));
      ASSERT_TRUE(b.image_pixel(b.project(p, &depth), &pb));
      EXPECT_LT((pa - pb).norm(), 1e-6);
    }
    EXPECT_FALSE(b.mask_path.empty());
  }
  EXPECT_EQ(find_ground_truth(folder.path()).curves.size(), scene.truth.curves.size());
  EXPECT_NEAR(find_ground_truth(folder.path()).extent, 40, 1e-3);
}

// Of cameras.txt, images.txt and points3D.txt, written down once more.
struct Model {
  std::string camera;
  std::vector<std::string> poses;                             // lines
  std::vector<std::vector<std::pair<Vector2d, int>>> sights;  // per image: pixel + 0.5, point
  std::vector<Vector3d> points;
};

Model read_model(const std::string& folder) {
  Model model;
  std::string line;
  std::ifstream cameras(folder + "/cameras.txt"), images(folder + "/images.txt"),
      points(folder + "/points3D.txt");
  while (std::getline(cameras, line))
    if (line[0] != '#') model.camera = line;
  while (std::getline(images, line)) {
    if (line[0] == '#') continue;
    model.poses.push_back(line);
    std::getline(images, line);
    model.sights.emplace_back();
    std::istringstream in(line);
    Vector2d pixel;
    for (int point; in >> pixel.x() >> pixel.y() >> point;)
      model.sights.back().push_back({pixel, point});
  }
  while (std::getline(points, line)) {
    if (line[0] == '#') continue;
    std::istringstream in(line);
    int id;
    Vector3d p;
    in >> id >> p.x() >> p.y() >> p.z();
    EXPECT_EQ(id, int(model.points.size()) + 1);
    model.points.push_back(p);
  }
  return model;
}

TEST(PhotographModels, TiePointsLieOnSurfacesAndWherePicturesShowThem) {
  const TempFolder folder;
  SynthesizeOptions options = small();
  options.rig.views = 10;
  options.rig.resolution = 128;
  const SyntheticScene scene = synthesize(options);
  write_scene(scene, folder.path());
  const Model model = read_model(folder.path() + "/sparse/0");
  EXPECT_GT(model.points.size(), 200u);
  ASSERT_EQ(model.sights.size(), 10u);
  std::vector<int> tracks(model.points.size(), 0);
  for (int k = 0; k < 10; ++k) {
    const Vector3f eye = scene.unit_views[k].center_in_world().cast<float>();
    for (const auto& [pixel, id] : model.sights[k]) {
      const Vector3d& p = model.points.at(id - 1);
      ++tracks[id - 1];
      double depth;
      Vector2d drawn;
      ASSERT_TRUE(scene.views[k].image_pixel(scene.views[k].project(p, &depth), &drawn));
      EXPECT_LT((drawn - pixel + Vector2d(0.5, 0.5)).norm(), 2e-3);
      const Vector3f in_unit = (p - Vector3d::Constant(0.5)).cast<float>();
      const Hit hit = scene.photo->tracer.cast(eye, in_unit - eye);
      EXPECT_NEAR(hit.depth, 1, 1e-3);
    }
  }
  EXPECT_GE(*std::min_element(tracks.begin(), tracks.end()), 3);
}

TEST(PhotographModels, ALensThatIsNotStatedIsInThePicturesAllTheSame) {
  SynthesizeOptions options = small();
  options.rig.resolution = 128;
  const SyntheticScene stated = synthesize(options);
  options.photo.state_lens = false;
  const SyntheticScene silent = synthesize(options);
  EXPECT_EQ(render(stated, 0).red.data, render(silent, 0).red.data);
  const TempFolder folder;
  write_scene(silent, folder.path());
  EXPECT_THAT(read_model(folder.path() + "/sparse/0").camera, testing::HasSubstr(" PINHOLE "));
  EXPECT_THAT(read_model(folder.path() + "/true").camera, testing::HasSubstr(" OPENCV "));
  options.photo.distortion = 0;
  EXPECT_NE(render(synthesize(options), 0).red.data, render(silent, 0).red.data);
}

TEST(PhotographModels, MasksAndTrueModelAreThereWhereTheyAreWanted) {
  const TempFolder folder;
  SynthesizeOptions options = small();
  options.rig.resolution = 64;
  options.photo.masks = false;
  options.degrade.missing = 0.34;
  write_scene(synthesize(options), folder.path());
  EXPECT_FALSE(std::filesystem::exists(folder.path() + "/masks"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() + "/true"));
  const Scene scene = open_scene(folder.path());
  EXPECT_EQ(scene.views.size(), 2u);
  EXPECT_EQ(scene.warnings.size(), 1u);
}

}  // namespace
}  // namespace sketchsplat
