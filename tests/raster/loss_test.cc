// SPDX-License-Identifier: MIT
#include "raster/splats/loss.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sketchsplat {
namespace {

class LossKinds : public testing::TestWithParam<LossKind> {};
INSTANTIATE_TEST_SUITE_P(Both, LossKinds,
                         testing::Values(LossKind::kSquared, LossKind::kCharbonnier));

TEST_P(LossKinds, IsZeroAndFlatWhereTheImageIsTheTarget) {
  const LossOptions options{GetParam(), 0.05, 3.0, 1.0};
  for (const double E : {0.0, 0.3, 1.0}) {
    double slope = 1;
    EXPECT_EQ(pixel_loss(E, E, options, &slope), 0);
    EXPECT_EQ(slope, 0);
  }
}

TEST_P(LossKinds, DerivativeIsThatOfTheValue) {
  const LossOptions options{GetParam(), 0.05, 3.0, 0.5};
  const double h = 1e-6;
  for (const double E : {0.0, 0.4, 1.0}) {
    for (const double I : {0.0, 0.38, 0.42, 0.9}) {
      double slope;
      pixel_loss(I, E, options, &slope);
      const double difference =
          (pixel_loss(I + h, E, options) - pixel_loss(I - h, E, options)) / (2 * h);
      EXPECT_NEAR(slope, difference, 1e-8);
    }
  }
}

TEST(Loss, CharbonnierIsL1FarFromZero) {
  const LossOptions options{LossKind::kCharbonnier, 1e-4, 1, 1};
  EXPECT_NEAR(pixel_loss(0.2, 0.9, options), 0.7, 2e-4);
}

TEST(Loss, WeightsAreThoseOfEdgeAndBackground) {
  const LossOptions options{LossKind::kSquared, 0.05, 8.0, 2.0};
  EXPECT_DOUBLE_EQ(pixel_loss(0, 1, options), 8 * 0.5);
  EXPECT_DOUBLE_EQ(pixel_loss(1, 0, options), 2 * 0.5);
}

TEST(Loss, BackgroundPerEdgeCountsEveryPixelOnce) {
  Image<float> edges(10, 10);
  edges.at(0, 0) = edges.at(9, 9) = 1;  // both ends: no part of the image is favoured
  EXPECT_DOUBLE_EQ(background_per_edge(edges), 49);
  EXPECT_DOUBLE_EQ(background_per_edge(Image<float>(10, 10)), 1);
}

TEST(EdgeTarget, KeepsEveryPixelAndMarksWhatIsOutside) {
  Image<float> edges(21, 11);
  for (size_t k = 0; k < edges.data.size(); ++k) edges.data[k] = float(k % 7) / 7;
  const EdgeTarget target = make_edge_target(edges, LossOptions());
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
  const LossOptions options{LossKind::kSquared, 0.05, 1, 1};
  EXPECT_DOUBLE_EQ(make_edge_target(edges, options).empty_loss, 0.5 + 0.125);
}

TEST(EdgeTarget, SharesOneTileWhereNoEdgeIs) {
  Image<float> edges(800, 800);
  edges.at(400, 400) = 1;
  EXPECT_EQ(make_edge_target(edges, LossOptions()).tiles.size(), 2u);
}

TEST(EdgeTarget, ClampsWhatIsNoGreyValue) {
  Image<float> edges(8, 8);
  edges.at(0, 0) = 7;
  edges.at(1, 0) = -7;
  edges.at(2, 0) = std::numeric_limits<float>::quiet_NaN();
  const EdgeTarget target = make_edge_target(edges, LossOptions());
  const float* value = target.tiles[target.tile_index[0]].value;
  EXPECT_EQ(value[0], 1);
  EXPECT_EQ(value[1], 0);
  EXPECT_EQ(value[2], 0);
  EXPECT_TRUE(std::isfinite(target.empty_loss));
}

TEST(EdgeTarget, OfNoPixelsHasNoLoss) {
  const EdgeTarget target = make_edge_target({}, LossOptions());
  EXPECT_EQ(target.empty_loss, 0);
  EXPECT_TRUE(target.tile_index.empty());
}

}  // namespace
}  // namespace sketchsplat
