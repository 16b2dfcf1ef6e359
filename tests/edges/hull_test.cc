// SPDX-License-Identifier: MIT
#include "edges/views/hull.h"

#include <gtest/gtest.h>

#include "tests/support/strokes.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;
const Vector3d kMiddle(0.5, 0.5, 0.5);

// A solid cube from 0.2 to 0.8, its edges and its masks.
EdgeWorld cube_world(bool masks, double unit = 1) {
  const Vector3d low = unit * Vector3d(0.2, 0.2, 0.2);
  std::vector<View> views = ring_of_views(60, unit * kMiddle, 3 * unit);
  std::vector<EdgelMap> maps;
  for (View& v : views) {
    v = smaller(v, 120);
    maps.push_back(ideal_edgels(v, cube_edges(low, 0.6 * unit)));
    if (masks) maps.back().mask = convex_mask(v, cube_corners(low, 0.6 * unit));
  }
  return make_edge_world(views, maps);
}

TEST(VisualHull, AFrontPointOfACubeIsSurelyVisibleAndABackPointIsNot) {
  for (double unit : {1.0, 1e-3, 1e3}) {
    const VisualHull hull(cube_world(true, unit), 32);
    ASSERT_FALSE(hull.empty());
    const auto seen = [&](const Vector3d& p, const Vector3d& camera) {
      return hull.surely_visible(unit * p, unit * camera);
    };
    const Vector3d above(0.5, 0.5, 3.5), aside(3.5, 0.5, 0.5);
    EXPECT_TRUE(seen({0.5, 0.5, 0.8}, above));
    EXPECT_FALSE(seen({0.5, 0.5, 0.2}, above));
    EXPECT_TRUE(seen({0.8, 0.5, 0.5}, aside));
    EXPECT_FALSE(seen({0.2, 0.5, 0.5}, aside));
    EXPECT_FALSE(seen({0.5, 0.5, 0.5}, above)) << "inside";
    EXPECT_TRUE(seen({0.8, 0.8, 0.8}, {3, 3, 3})) << "corner";
    EXPECT_FALSE(seen({0.2, 0.2, 0.2}, {3, 3, 3})) << "corner behind";
    EXPECT_TRUE(seen({0.5, 0.5, 1.5}, above)) << "in the air";
  }
}

TEST(VisualHull, AWallTwoCellsThickHidesWhatIsBehindIt) {
  const VisualHull hull(cube_world(true), 12);
  const double cell = 0.6 / 12;
  for (const Vector3d& camera : {Vector3d(0.5, 0.5, 3.5), Vector3d(0.6, 0.9, 3.5)}) {
    EXPECT_TRUE(hull.surely_visible({0.52, 0.47, 0.8}, camera));
    EXPECT_FALSE(hull.surely_visible({0.52, 0.47, 0.8 - 2.4 * cell}, camera));
  }
}

TEST(VisualHull, ALineOfSightIsCutToWhereTheHullIs) {
  const VisualHull hull(cube_world(true), 64);
  constexpr double kCells = 4.0 / 64;
  const Vector3d above(0.5, 0.5, 3.5), down(0, 0, -1);
  double s0 = 0, s1 = 10;
  ASSERT_TRUE(hull.clip(above, down, 2.5, &s0, &s1));
  EXPECT_NEAR(s0, 2.7, kCells);
  EXPECT_NEAR(s1, 3.3, kCells);
  EXPECT_LT(s0, 2.7);
  EXPECT_GT(s1, 3.3);
  s0 = 0, s1 = 10;
  EXPECT_FALSE(hull.clip(above, Vector3d(1, 0, -1).normalized(), 2.5, &s0, &s1)) << "it passes by";
  EXPECT_TRUE(VisualHull().clip(above, down, 2.5, &s0, &s1));
  EXPECT_EQ(s0, 0) << "no hull tells nothing";
  EXPECT_EQ(s1, 10);
}

TEST(VisualHull, TheWorldBringsItsOwn) {
  const EdgeWorld w = cube_world(true);
  ASSERT_FALSE(w.hull.empty());
  EXPECT_TRUE(w.hull.surely_visible({0.5, 0.5, 0.8}, {0.5, 0.5, 3.5}));
}

// The same mask in the picture that the lens draws.
Image<uint8_t> bent_mask(const View& view, const Image<uint8_t>& straight) {
  Image<uint8_t> out(straight.width, straight.height);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      Eigen::Vector2d ideal;
      if (!view.ideal_pixel({double(x), double(y)}, &ideal)) continue;
      const int u = int(std::lround(ideal.x())), v = int(std::lround(ideal.y()));
      if (u >= 0 && v >= 0 && u < out.width && v < out.height) out.at(x, y) = straight.at(u, v);
    }
  return out;
}

TEST(VisualHull, MasksAreLookedUpThroughTheLens) {
  const EdgeWorld straight = cube_world(true);
  EdgeWorld bent = straight, forgotten = straight;
  Lens::Terms terms;
  terms.k1 = 8;
  for (size_t i = 0; i < bent.views.size(); ++i) {
    bent.views[i].lens = Lens(LensModel::kSimpleRadial, terms);
    bent.maps[i].mask = bent_mask(bent.views[i], straight.maps[i].mask);
    forgotten.maps[i].mask = bent.maps[i].mask;
  }
  const VisualHull truth(straight, 32), with(bent, 32), without(forgotten, 32);
  int agree = 0, agree_without = 0, n = 0;
  for (double x = 0.16; x < 0.85; x += 0.04)
    for (double y = 0.16; y < 0.85; y += 0.04)
      for (double z = 0.16; z < 0.85; z += 0.04, ++n) {
        const Vector3d p(x, y, z), camera(0.9, 0.1, 3.5);
        const bool seen = truth.surely_visible(p, camera);
        agree += with.surely_visible(p, camera) == seen;
        agree_without += without.surely_visible(p, camera) == seen;
      }
  EXPECT_GT(agree, 0.96 * n);
  EXPECT_LT(agree_without, 0.9 * n) << agree;
}

// A post before the cube in every sixth view, cut out of the mask there.
TEST(VisualHull, ThingsBeforeTheObjectCarveNothingOfIt) {
  EdgeWorld cut = cube_world(true);
  for (size_t i = 0; i < cut.maps.size(); i += 6) {
    Image<uint8_t>& mask = cut.maps[i].mask;
    for (int y = 0; y < mask.height; ++y)
      for (int x = 0; x < mask.width / 2; ++x) mask.at(x, y) = 0;
  }
  const VisualHull hull(cut, 64), whole(cube_world(true), 64);
  for (const Polyline& e : cube_edges(Vector3d(0.2, 0.2, 0.2), 0.6))
    for (const double t : {0.05, 0.5, 0.95}) {
      const Vector3d p = e[0] + t * (e[1] - e[0]);
      const Vector3d camera = kMiddle + 3 * (p - kMiddle).normalized();
      double s0 = 0, s1 = 10, t0 = 0, t1 = 10;
      ASSERT_TRUE(hull.clip(camera, (p - camera).normalized(), 0, &s0, &s1)) << p.transpose();
      EXPECT_TRUE(hull.surely_visible(p, camera)) << p.transpose();
      ASSERT_TRUE(whole.clip(camera, (p - camera).normalized(), 0, &t0, &t1));
      EXPECT_NEAR(s0, t0, 4 * 0.6 / 64) << "nor does it grow";
    }
  double s0 = 0, s1 = 10;
  EXPECT_FALSE(hull.clip({0.5, 0.5, 3.5}, Vector3d(1, 0, -1).normalized(), 0, &s0, &s1));
}

TEST(VisualHull, WithoutMasksNothingIsSure) {
  EXPECT_TRUE(cube_world(false).hull.empty());
  EXPECT_FALSE(cube_world(false).hull.surely_visible({0.5, 0.5, 0.8}, {0.5, 0.5, 3.5}));
  EXPECT_FALSE(VisualHull().surely_visible({0, 0, 0}, {0, 0, 3}));
  EXPECT_TRUE(VisualHull(EdgeWorld(), 32).empty());
}

TEST(VisualHull, TwoMasksAreTooFewAndAViewWithoutMaskDoesNotCarve) {
  EdgeWorld w = cube_world(true);
  for (size_t i = 2; i < w.maps.size(); ++i) w.maps[i].mask = Image<uint8_t>();
  EXPECT_TRUE(VisualHull(w, 32).empty());
  w = cube_world(true);
  w.maps[5].mask = Image<uint8_t>();
  EXPECT_FALSE(VisualHull(w, 32).surely_visible({0.5, 0.5, 0.2}, {0.5, 0.5, 3.5}));
}

TEST(VisualHull, MasksWithoutAnythingLeaveNoHullToHideBehind) {
  EdgeWorld w = cube_world(true);
  for (EdgelMap& m : w.maps) std::fill(m.mask.data.begin(), m.mask.data.end(), uint8_t(0));
  const VisualHull hull(w, 32);
  EXPECT_TRUE(hull.surely_visible({0.5, 0.5, 0.2}, {0.5, 0.5, 3.5}));
}

}  // namespace
}  // namespace sketchsplat
