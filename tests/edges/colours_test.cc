// SPDX-License-Identifier: MIT
// Colours of an object and of what is around it.
#include "edges/image/colours.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sketchsplat {
namespace {

TEST(Colours, SharesAddUpToOneAndAreNeverNone) {
  Colours seen;
  Picture one;
  one.red = one.green = one.blue = Image<float>(1, 1, 0.5f);
  const int bin = Colours::bins_of(one).data[0];
  for (int k = 0; k < 100; ++k) seen.add(bin);
  EXPECT_NEAR(seen.share(bin), 1, 1e-5);
  seen.spread();
  double sum = 0;
  for (int b = 0; b < 32 * 32 * 32; ++b) sum += seen.share(b);
  EXPECT_NEAR(sum, 1 + 0.0328, 1e-3) << "and a little of what was never seen";
  EXPECT_NEAR(seen.share(bin), std::pow(6. / 16, 3), 1e-4);
  EXPECT_GT(seen.share(0), 0);
}

TEST(Colours, OnePixelTellsThreeNatsAtMost) {
  EXPECT_NEAR(nats_of(0.2, 0.1), std::log(2), 1e-12);
  EXPECT_EQ(nats_of(1, 1e-6), 3);
  EXPECT_EQ(nats_of(1e-6, 1), -3);
}

TEST(Colours, OfAnObjectWithoutSurroundingsTellNothing) {
  constexpr int kSide = 20;
  Picture picture;
  picture.red = picture.green = picture.blue = Image<float>(kSide, kSide, 0.5f);
  Image<Side> side(kSide, kSide, Side::kObject);
  EXPECT_TRUE(odds_by_colours(picture, side).red.empty());
  for (int k = 0; k < 63; ++k) side.data[size_t(k)] = Side::kAround;
  EXPECT_TRUE(odds_by_colours(picture, side).red.empty()) << "too few";
  side.data[63] = Side::kAround;
  const Picture odds = odds_by_colours(picture, side);
  ASSERT_FALSE(odds.red.empty());
  EXPECT_NEAR(odds.red.at(5, 5), 0.5, 1e-6) << "both sides have the same colour";
}

}  // namespace
}  // namespace sketchsplat
