// SPDX-License-Identifier: MIT
#include "pipelines/survey/explained.h"

#include <gtest/gtest.h>

#include "tests/support/strokes.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;
const Vector3d kMiddle(0.5, 0.5, 0.5);
const Vector3d kA(0.2, 0.3, 0.5), kB(0.8, 0.4, 0.5), kC(0.3, 0.8, 0.4), kD(0.7, 0.7, 0.7);

EdgeWorld world_of(const std::vector<Polyline>& curves, int views) {
  const std::vector<View> ring = ring_of_views(views, kMiddle, 3);
  std::vector<EdgelMap> maps;
  for (const View& view : ring) maps.push_back(ideal_edgels(view, curves));
  return make_edge_world(ring, maps);
}

TEST(Explained, AllEdgelsAreByTheirOwnStrokesAndHalfWithoutOneOfTwo) {
  const EdgeWorld world = world_of({segment(kA, kB), segment(kC, kD)}, 8);
  Sketch one, two;
  add_line(&one, kA, kB), add_line(&two, kA, kB), add_line(&two, kC, kD);
  EXPECT_GT(explained(two, world).share, 0.95);
  const double half = explained(one, world).share;
  EXPECT_NEAR(half, (kB - kA).norm() / ((kB - kA).norm() + (kD - kC).norm()), 0.1);
  EXPECT_EQ(explained({}, world).share, 0);
}

TEST(Explained, EdgelsUnderTwoStrokesCountOnce) {
  const EdgeWorld world = world_of({segment(kA, kB)}, 8);
  Sketch once, twice;
  add_line(&once, kA, kB);
  add_line(&twice, kA, kB), add_line(&twice, kA, kB + Vector3d(0, 0, 0.001));
  EXPECT_NEAR(explained(twice, world).share, explained(once, world).share, 0.02);
  EXPECT_LE(explained(twice, world).share, 1);
}

TEST(Explained, AViewOfSomethingElseDoesNotFit) {
  EdgeWorld world = world_of({segment(kA, kB), segment(kC, kD)}, 8);
  std::vector<EdgelMap> maps = world.maps;
  maps[5] = ideal_edgels(world.views[5], {segment({0.1, 0.9, 0.2}, {0.2, 0.1, 0.9})});
  world = make_edge_world(world.views, maps);
  Sketch s;
  add_line(&s, kA, kB), add_line(&s, kC, kD);
  const std::vector<char> unfit = unfit_views(explained(s, world));
  for (int v = 0; v < 8; ++v) EXPECT_EQ(unfit[v], v == 5) << v;
}

}  // namespace
}  // namespace sketchsplat
