// SPDX-License-Identifier: MIT
#include "edges/views/recast.h"

#include <gtest/gtest.h>

#include <memory>

#include "tests/support/strokes.h"
#include "tests/support/wireframe.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT

TEST(WithoutViews, WhatIsKnownOfTheOthersStaysTheirs) {
  const std::vector<View> views = ring_of_views(5, {0.5, 0.5, 0.5}, 3);
  EdgeWorld world = ideal_world(views, cube_edges({0.1, 0.1, 0.1}, 0.8));
  for (int v = 0; v < 5; ++v) world.views[v].name = std::to_string(v);
  EXPECT_FALSE(without_views(world, {1, 0, 0, 0, 0}).silhouettes);
  std::vector<Image<uint8_t>> silhouettes(5);
  for (int v = 0; v < 5; ++v) silhouettes[v] = Image<uint8_t>(v + 1, 1);
  world.silhouettes = std::make_shared<const std::vector<Image<uint8_t>>>(silhouettes);
  const EdgeWorld rest = without_views(world, {0, 1, 0, 1, 0});
  ASSERT_EQ(rest.views.size(), 3u);
  ASSERT_EQ(rest.silhouettes->size(), 3u);
  for (int k = 0; k < 3; ++k) {
    const int v = 2 * k;
    EXPECT_EQ(rest.views[k].name, std::to_string(v));
    EXPECT_EQ((*rest.silhouettes)[k].width, v + 1);
    EXPECT_EQ(rest.maps[k].edgels.size(), world.maps[v].edgels.size());
    EXPECT_EQ(rest.plane_normal[k], world.plane_normal[v]);
  }
}

}  // namespace
}  // namespace sketchsplat
