// SPDX-License-Identifier: MIT
#include "edges/hull.h"

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

TEST(VisualHull, TheWorldBringsItsOwn) {
  const EdgeWorld w = cube_world(true);
  ASSERT_FALSE(w.hull.empty());
  EXPECT_TRUE(w.hull.surely_visible({0.5, 0.5, 0.8}, {0.5, 0.5, 3.5}));
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
