// SPDX-License-Identifier: MIT
#include "raster/splats/loss.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sketchsplat {
namespace {

TEST(EdgeTarget, KeepsEveryPixelAndMarksWhatIsOutside) {
  Image<float> edges(21, 11);
  for (size_t k = 0; k < edges.data.size(); ++k) edges.data[k] = float(k % 7) / 7;
  const EdgeTarget target = make_edge_target(edges);
  ASSERT_EQ(target.tiles_x, 3);
  ASSERT_EQ(target.tiles_y, 2);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 24; ++x) {
      const Tile& tile = target.tiles[target.tile_index[y / 8 * 3 + x / 8]];
      EXPECT_EQ(tile.value[y % 8 * 8 + x % 8], x < 21 && y < 11 ? edges.at(x, y) : -1.0f);
    }
  }
}

TEST(EdgeTarget, EmptyLossIsTheSumOverThePixels) {
  Image<float> edges(21, 11);
  edges.at(20, 10) = 1;
  edges.at(3, 2) = 0.5;
  EXPECT_DOUBLE_EQ(make_edge_target(edges).empty_loss, 0.5 + 0.125);
}

TEST(EdgeTarget, SharesOneTileWhereNoEdgeIs) {
  Image<float> edges(800, 800);
  edges.at(400, 400) = 1;
  EXPECT_EQ(make_edge_target(edges).tiles.size(), 2u);
}

TEST(EdgeTarget, ClampsWhatIsNoGreyValue) {
  Image<float> edges(8, 8);
  edges.at(0, 0) = 7;
  edges.at(1, 0) = -7;
  edges.at(2, 0) = std::numeric_limits<float>::quiet_NaN();
  const EdgeTarget target = make_edge_target(edges);
  const float* value = target.tiles[target.tile_index[0]].value;
  EXPECT_EQ(value[0], 1);
  EXPECT_EQ(value[1], 0);
  EXPECT_EQ(value[2], 0);
  EXPECT_TRUE(std::isfinite(target.empty_loss));
}

TEST(EdgeTarget, OfNoPixelsHasNoLoss) {
  const EdgeTarget target = make_edge_target({});
  EXPECT_EQ(target.empty_loss, 0);
  EXPECT_TRUE(target.tile_index.empty());
}

}  // namespace
}  // namespace sketchsplat
