// SPDX-License-Identifier: MIT
#include "edges/image/hatching.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sketchsplat {
namespace {

constexpr int kSide = 100, kMiddle = 50;

// Appends an upright chain through the picture.
void add_line(EdgelMap* map, float x, float strength, float nx = 1, float ny = 0) {
  for (int y = 0; y < kSide; ++y) map->edgels.push_back({x, float(y), nx, ny, strength, 1, false});
}

double chance_in_the_middle(const EdgelMap& map) {
  Edgel middle{kMiddle, kMiddle, 1, 0, 0.1f, 1, false};
  return Hatching(map, {kSide, kSide}).chance(middle);
}

double by_bayes(int rungs) { return 1 / (1 + 999 * std::pow(0.25, rungs)); }

TEST(Hatching, ALoneEdgeIsOfHatchingOnceInAThousand) {
  EdgelMap map;
  add_line(&map, kMiddle, 0.1f);
  EXPECT_NEAR(chance_in_the_middle(map), 0.001, 1e-9);
}

TEST(Hatching, EveryRungToBothSidesCountsOfEitherSign) {
  for (int sides = 1; sides <= 2; ++sides) {
    EdgelMap map;
    add_line(&map, kMiddle, 0.1f);
    for (int n = 1; n <= 12; ++n) {
      add_line(&map, kMiddle + 3.4f * float(n), 0.1f, n % 2 ? -1.f : 1.f);
      if (sides == 2) add_line(&map, kMiddle - 3.4f * float(n), 0.1f, n % 2 ? -1.f : 1.f);
      EXPECT_NEAR(chance_in_the_middle(map), by_bayes(sides * n), 1e-9) << n << " " << sides;
    }
  }
}

TEST(Hatching, WeakLinesBesideAStrongEdgeAreNoRungs) {
  EdgelMap map;
  for (int n = -12; n <= 12; ++n) add_line(&map, kMiddle + 3 * float(n), n == 0 ? 0.1f : 0.04f);
  EXPECT_NEAR(chance_in_the_middle(map), 0.001, 1e-9);
}

TEST(Hatching, LinesEightPixelsApartAreNone) {
  EdgelMap map;
  for (int n = -4; n <= 4; ++n) add_line(&map, kMiddle + 8 * float(n), 0.1f);
  EXPECT_NEAR(chance_in_the_middle(map), 0.001, 1e-9);
}

TEST(Hatching, WhatRunsElsewhereIsNoRung) {
  EdgelMap map;
  const float turn = 20 * float(M_PI) / 180;
  for (int n = -12; n <= 12; ++n)
    add_line(&map, kMiddle + 3 * float(n), 0.1f, std::cos(turn), std::sin(turn));
  EXPECT_NEAR(chance_in_the_middle(map), 0.001, 1e-9);
}

TEST(Hatching, ARowEndsAtTheBorderOfThePicture) {
  EdgelMap map;
  add_line(&map, 0, 0.1f);
  add_line(&map, 3, 0.1f);
  Hatching hatching(map, {kSide, kSide});
  EXPECT_NEAR(hatching.chance(map.edgels[0]), by_bayes(1), 1e-9);
  EXPECT_NEAR(hatching.chance(map.edgels[kSide - 1]), by_bayes(1), 1e-9);
}

}  // namespace
}  // namespace sketchsplat
