// SPDX-License-Identifier: MIT
// Photograph-like scenes that are there as COLMAP's and as nerfstudio's, if they are there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "datasets/readers/scene.h"

namespace sketchsplat {
namespace {

class Photographs : public testing::TestWithParam<const char*> {};

TEST_P(Photographs, AreTheSameInBothFormats) {
  const std::string folder =
      std::string(SKETCHSPLAT_SOURCE_DIR) + "/../shared/data/photos-true/" + GetParam();
  if (!std::filesystem::exists(folder))
    GTEST_SKIP() << "the scene " << GetParam() << " is not beside the sources in shared/data";
  const Scene a = open_scene(folder), b = open_scene(folder, "colmap");
  EXPECT_EQ(a.format, "nerfstudio");
  EXPECT_TRUE(a.warnings.empty() && b.warnings.empty());
  ASSERT_EQ(a.views.size(), 24u);
  ASSERT_EQ(b.views.size(), 24u);
  ASSERT_GT(b.points.size(), 500u);
  for (size_t i = 0; i < a.views.size(); ++i) {
    const View &u = a.views[i], &v = b.views[i];
    EXPECT_EQ(u.name, v.name);
    EXPECT_EQ(std::filesystem::canonical(u.mask_path), std::filesystem::canonical(v.mask_path));
    const Image<float> mask = read_picture(v).alpha;
    int seen = 0, on_object = 0;
    for (const ScenePoint& point : b.points) {
      const auto sight = std::find_if(point.sights.begin(), point.sights.end(),
                                      [&](const PointSight& s) { return s.view == int(i); });
      if (sight == point.sights.end()) continue;
      double depth;
      Eigen::Vector2d p, q;
      ASSERT_TRUE(u.image_pixel(u.project(point.position, &depth), &p));
      ASSERT_TRUE(v.image_pixel(v.project(point.position, &depth), &q));
      EXPECT_LT((p - q).norm(), 1e-4);
      EXPECT_LT((sight->pixel - q).norm(), 0.1);
      EXPECT_GT(depth, 0);
      EXPECT_TRUE(v.camera.contains(q)) << q.transpose();
      on_object += mask.at(int(std::lround(q.x())), int(std::lround(q.y()))) > 0.5f;
      ++seen;
    }
    EXPECT_GT(seen, 100);
    EXPECT_GT(on_object, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Photographs, testing::Values("pockets", "shaft"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace sketchsplat
