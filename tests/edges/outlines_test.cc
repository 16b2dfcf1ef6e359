// SPDX-License-Identifier: MIT
// Where colours tell that an object ends: its silhouette and its outlines.
#include "edges/views/outlines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/strokes.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT

constexpr int kSide = 160;
constexpr double kMiddle = 80.3, kRadius = 50;

double from_middle(double x, double y) { return std::hypot(x - kMiddle, y - kMiddle); }

Image<uint8_t> disc(double radius) {
  Image<uint8_t> out(kSide, kSide);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) out.at(x, y) = from_middle(x, y) < radius;
  return out;
}

// A pale pink disc with dark spots on wood that is no darker than the spots and no brighter than
// the disc.
Picture spotted_disc() {
  Picture out;
  for (Image<float>* c : {&out.red, &out.green, &out.blue}) *c = Image<float>(kSide, kSide);
  std::mt19937 rng(7);
  std::normal_distribution<float> noise(0, 0.01f);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const bool on = from_middle(x, y) < kRadius, spot = x % 9 < 4 && y % 9 < 4;
      const float grain = 0.08f * float(std::sin(0.7 * x + 0.2 * y));
      out.red.at(x, y) = (!on ? 0.55f + grain : spot ? 0.3f : 0.7f) + noise(rng);
      out.green.at(x, y) = (!on ? 0.42f + grain : spot ? 0.28f : 0.65f) + noise(rng);
      out.blue.at(x, y) = (!on ? 0.25f + grain : spot ? 0.32f : 0.68f) + noise(rng);
    }
  return out;
}

// Of a circle about the middle, how many of 360 places have an edgel within 1.5 px.
int places_found(const EdgelMap& map, double radius) {
  int out = 0;
  for (int k = 0; k < 360; ++k) {
    const double x = kMiddle + radius * std::cos(k * M_PI / 180),
                 y = kMiddle + radius * std::sin(k * M_PI / 180);
    bool near = false;
    for (const Edgel& e : map.edgels) near |= std::hypot(e.x - x, e.y - y) < 1.5;
    out += near;
  }
  return out;
}

View whole_picture() {
  View view = ring_of_views(3, {0.5, 0.5, 0.5}, 3)[0];
  view.camera.width = view.camera.height = kSide;
  return view;
}

TEST(Outlines, OfSpottedThingsAreToldByColoursWhereBrightnessBreaksThem) {
  const Picture picture = spotted_disc();
  const Image<uint8_t> mask = disc(kRadius + 2);
  const double slack = 4;
  const EdgelMap plain = detect_edges(picture, DetectOptions());
  const EdgelMap odds =
      detect_edges(odds_by_colours(picture, sides_of(mask, slack)), DetectOptions());
  EdgelMap both = plain;
  add_outlines(odds, whole_picture(), mask, slack, 6, &both);
  EXPECT_LT(places_found(plain, kRadius), 300) << "else this tests nothing";
  EXPECT_GT(places_found(both, kRadius), 340);
  for (size_t i = plain.edgels.size(); i < both.edgels.size(); ++i)
    EXPECT_NEAR(from_middle(both.edgels[i].x, both.edgels[i].y), kRadius, 2.5)
        << "nothing but outlines";
}

TEST(Outlines, OfColoursEndSilhouettesThatReachTooFar) {
  const Picture picture = spotted_disc();
  Image<uint8_t> mask = disc(kRadius + 9);
  double slack = 12;
  trim_silhouette(odds_by_colours(picture, sides_of(mask, slack)), &mask, &slack);
  EXPECT_EQ(slack, 4);
  int beyond = 0, missed = 0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      beyond += mask.at(x, y) && from_middle(x, y) > kRadius + slack;
      missed += !mask.at(x, y) && from_middle(x, y) < kRadius;
    }
  EXPECT_EQ(missed, 0);
  EXPECT_LT(beyond, 0.02 * M_PI * kRadius * kRadius) << "of 0.3 before";
}

TEST(Outlines, APatchOfTheSurroundingsColoursWithinTheObjectIsNotTrimmed) {
  Picture picture = spotted_disc();
  const auto of_patch = [](int x, int y) { return std::hypot(x - kMiddle - 40, y - kMiddle) < 6; };
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x)
      if (of_patch(x, y))
        for (Image<float>* c : {&picture.red, &picture.green, &picture.blue})
          c->at(x, y) = c->at(x - 34, 5);  // wood
  Image<uint8_t> mask = disc(kRadius + 2);
  double slack = 12;
  trim_silhouette(odds_by_colours(picture, sides_of(mask, slack)), &mask, &slack);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) EXPECT_TRUE(mask.at(x, y) || !of_patch(x, y)) << x << " " << y;
}

TEST(Outlines, WhereColoursDoNotTellSilhouettesStayAsTheyAre) {
  Picture grey;
  grey.red = grey.green = grey.blue = Image<float>(kSide, kSide, 0.5f);
  Image<uint8_t> mask = disc(kRadius + 9);
  double slack = 12;
  trim_silhouette(odds_by_colours(grey, sides_of(mask, slack)), &mask, &slack);
  EXPECT_EQ(mask.data, disc(kRadius + 9).data);
}

// Circles within the object, on its border and beside it.
TEST(Outlines, LieAtTheEndOfTheSilhouette) {
  EdgelMap odds;
  odds.width = odds.height = kSide;
  odds.chain = {0};
  for (const double radius : {30., kRadius, 58.}) {
    for (int k = 0; k < 360; ++k) {
      Edgel e;
      e.nx = float(std::cos(k * M_PI / 180)), e.ny = float(std::sin(k * M_PI / 180));
      e.x = float(kMiddle + radius * e.nx), e.y = float(kMiddle + radius * e.ny);
      odds.edgels.push_back(e);
    }
    odds.chain.push_back(int(odds.edgels.size()));
  }
  EdgelMap map;
  map.width = map.height = kSide;
  add_outlines(odds, whole_picture(), disc(kRadius + 2), 4, 6, &map);
  EXPECT_EQ(map.num_chains(), 1);
  ASSERT_EQ(map.edgels.size(), 360u);
  for (const Edgel& e : map.edgels) EXPECT_NEAR(from_middle(e.x, e.y), kRadius, 0.01);
}

TEST(Outlines, ThatBrightnessTellsAreNotAddedTwice) {
  Picture picture = spotted_disc();
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x)
      if (from_middle(x, y) < kRadius)
        picture.red.at(x, y) = picture.green.at(x, y) = picture.blue.at(x, y) = 0.9f;
  const Image<uint8_t> mask = disc(kRadius + 2);
  EdgelMap map = detect_edges(picture, DetectOptions());
  const size_t before = map.edgels.size();
  add_outlines(detect_edges(odds_by_colours(picture, sides_of(mask, 4)), DetectOptions()),
               whole_picture(), mask, 4, 6, &map);
  EXPECT_EQ(map.edgels.size(), before);
}

}  // namespace
}  // namespace sketchsplat
