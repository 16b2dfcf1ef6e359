// SPDX-License-Identifier: MIT
#include "edges/image/coarser.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace sketchsplat {
namespace {

constexpr int kSide = 96;
constexpr double kMiddle = 47.7;  // of both axes

// What `share` [0 to 1] of a pixel is brighter by `contrast`, both of 255, in noise.
template <typename Share>
Picture picture_of(double contrast, double noise, Share share) {
  Picture p;
  p.red = p.green = p.blue = Image<float>(kSide, kSide, 0.f);
  std::mt19937 rng(3);
  std::normal_distribution<double> normal(0, noise);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      double sum = 0;
      for (int i = 0; i < 8; ++i)
        for (int j = 0; j < 8; ++j) sum += share(x + (i - 3.5) / 8, y + (j - 3.5) / 8);
      const double value = (120 + contrast * sum / 64 + normal(rng)) / 255;
      p.red.at(x, y) = p.green.at(x, y) = p.blue.at(x, y) = float(value);
    }
  return p;
}

bool right_half(double x, double) { return x > kMiddle; }

// Grey levels as files have them.
Picture in_whole_levels(Picture p) {
  for (float& v : p.red.data) v = std::round(v * 255) / 255;
  p.green = p.blue = p.red;
  return p;
}

DetectOptions finest_alone() {
  DetectOptions options;
  options.coarser = 0;
  return options;
}

size_t edgels_near_middle(const EdgelMap& map) {
  size_t out = 0;
  for (const Edgel& e : map.edgels) out += std::abs(e.x - kMiddle) < 1;
  return out;
}

TEST(Coarser, ShowsAStepThatNoiseHidesAtTheFinestScale) {
  const Picture step = picture_of(36, 20, right_half);
  EXPECT_LT(edgels_near_middle(detect_edges(step, finest_alone())), kSide / 3u);
  const EdgelMap map = detect_edges(step, {});
  EXPECT_GT(edgels_near_middle(map), 8 * kSide / 10u);
  EXPECT_LT(map.edgels.size() - edgels_near_middle(map), kSide / 10u) << "elsewhere";
}

TEST(Coarser, LeavesAPictureAloneWhereNoNoiseHidesAnything) {
  const Picture step = picture_of(40, 0.5, right_half);
  const EdgelMap all = detect_edges(step, {}), fine = detect_edges(step, finest_alone());
  ASSERT_EQ(all.edgels.size(), fine.edgels.size());
  for (size_t i = 0; i < all.edgels.size(); ++i) EXPECT_EQ(all.edgels[i].x, fine.edgels[i].x);
}

TEST(Coarser, ShowsAStepOfTwoGreyLevelsInTheNoiseThatDithersThem) {
  const Picture step = in_whole_levels(picture_of(2, 0.5, right_half));
  EXPECT_GT(edgels_near_middle(detect_edges(step, {})), 7 * kSide / 10u);
}

// A ramp has a step of one grey level every 16 px.
TEST(Coarser, StepsOfGreyLevelsAreNoEdges) {
  const auto ramp = [](double x, double y) { return (0.8 * x + 0.6 * y) / 16; };
  EXPECT_EQ(detect_edges(in_whole_levels(picture_of(1, 0, ramp)), {}).edgels.size(), 0u);
  EXPECT_LT(detect_edges(in_whole_levels(picture_of(1, 0.5, ramp)), {}).edgels.size(), 10u);
}

// Noise that compression made coarse, of squares of 2 x 2 pixels, promises nothing of steps.
TEST(Coarser, NoiseThatIsNotWhiteLowersNoThreshold) {
  Picture step = in_whole_levels(picture_of(2, 0.6, right_half));
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const float other = step.red.at(x & ~1, y & ~1);
      step.green.at(x, y) = step.blue.at(x, y) = other;
    }
  step.red = step.blue;
  EXPECT_LT(detect_edges(step, {}).edgels.size(), kSide / 10u);
}

// A scale of 2 px shows a disc of 10 px smaller by 0.2 px, and its edge twice as wide.
TEST(Coarser, ShowsADiscAsLargeAndAsSharpAsTheFinestScaleWould) {
  constexpr double kRadius = 10;
  const auto disc = [](double x, double y) {
    return std::hypot(x - kMiddle, y - kMiddle) < kRadius;
  };
  DetectOptions fine = finest_alone(), coarse = finest_alone();
  coarse.sigma_px = 2;
  const Picture picture = picture_of(100, 1, disc);
  const auto mean = [](const EdgelMap& map, auto value) {
    double sum = 0;
    for (const Edgel& e : map.edgels) sum += value(e);
    return sum / double(map.edgels.size());
  };
  const auto radius = [](const Edgel& e) { return std::hypot(e.x - kMiddle, e.y - kMiddle); };
  const EdgelMap by_fine = detect_edges(picture, fine), by_coarse = detect_edges(picture, coarse);
  EXPECT_LT(mean(by_coarse, radius), mean(by_fine, radius) - 0.1);
  EdgelMap map;
  map.width = map.height = kSide;
  add_coarser(by_coarse, coarse.sigma_px, fine.sigma_px, fine.min_chain, &map);
  ASSERT_GT(map.edgels.size(), 50u);
  EXPECT_NEAR(mean(map, radius), mean(by_fine, radius), 0.03);
  EXPECT_NEAR(mean(map, radius), kRadius, 0.1);
  const auto width = [](const Edgel& e) { return e.width; };
  const auto strength = [](const Edgel& e) { return e.strength; };
  EXPECT_NEAR(mean(map, width) / mean(by_fine, width), 1, 0.1);
  EXPECT_NEAR(mean(map, strength) / mean(by_fine, strength), 1, 0.1);
}

TEST(Coarser, AddsNothingBesideFinerEdgelsNorWhatIsMuchWider) {
  const auto chain_at = [](float x, float width) {
    EdgelMap map;
    map.width = map.height = kSide;
    for (int y = 10; y < 50; ++y) {
      Edgel e;
      e.x = x, e.y = float(y), e.nx = 1, e.width = width, e.strength = 0.1f;
      map.edgels.push_back(e);
    }
    map.chain = {0, 40};
    return map;
  };
  const auto added = [&](float x, float width) {
    EdgelMap map = chain_at(20, 1.1f);
    add_coarser(chain_at(x, width), 2, 1, 6, &map);
    return map.edgels.size() - 40;
  };
  EXPECT_EQ(added(22, 2), 0u) << "the same edge";
  EXPECT_EQ(added(30, 2), 40u) << "another one, sharp";
  EXPECT_EQ(added(30, 4), 0u) << "shading";
}

}  // namespace
}  // namespace sketchsplat
