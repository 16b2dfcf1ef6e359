// SPDX-License-Identifier: MIT
#include "edges/image/meaningful.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "edges/views/focus.h"

namespace sketchsplat {
namespace {

Picture grey_picture(int w, int h, float value) {
  Picture p;
  p.red = p.green = p.blue = Image<float>(w, h, value);
  return p;
}

void add(Picture* p, int x, int y, double v) {
  p->red.at(x, y) += float(v), p->green.at(x, y) += float(v), p->blue.at(x, y) += float(v);
}

void add_noise(Picture* p, double sigma) {
  std::mt19937 rng(3);
  std::normal_distribution<double> normal(0, sigma);
  for (int y = 0; y < p->height(); ++y)
    for (int x = 0; x < p->width(); ++x) add(p, x, y, normal(rng));
}

// Bright and dark blobs of two pixels, as speckled paint has them.
void add_speckles(Picture* p, int count, double contrast) {
  std::mt19937 rng(5);
  std::uniform_real_distribution<double> u(0, p->width()), v(0, p->height()), sign(-1, 1);
  for (int k = 0; k < count; ++k) {
    const double x0 = u(rng), y0 = v(rng), s = contrast * sign(rng);
    for (int y = std::max(0, int(y0) - 5); y < std::min(p->height(), int(y0) + 6); ++y)
      for (int x = std::max(0, int(x0) - 5); x < std::min(p->width(), int(x0) + 6); ++x)
        add(p, x, y, s * std::exp(-0.5 * (std::pow(x - x0, 2) + std::pow(y - y0, 2)) / 2.5));
  }
}

void add_step(Picture* p, double height) {  // a slanted line through the whole picture
  for (int y = 0; y < p->height(); ++y)
    for (int x = 0; x < p->width(); ++x)
      add(p, x, y, height / (1 + std::exp(-(x - 0.3 * y - 40) / 0.5)));
}

void add_disk(Picture* p, double x0, double y0, double radius, double height) {
  for (int y = 0; y < p->height(); ++y)
    for (int x = 0; x < p->width(); ++x)
      add(p, x, y, height / (1 + std::exp((std::hypot(x - x0, y - y0) - radius) / 0.4)));
}

int on_step(const EdgelMap& map) {
  int n = 0;
  for (const Edgel& e : map.edgels) n += std::abs(e.x - 0.3 * e.y - 40) < 1.5;
  return n;
}

DetectOptions everything() {
  DetectOptions options;
  options.meaning.most_false = options.meaning.most_sides = 0;
  return options;
}

TEST(Meaningful, AnEdgeInSpecklesOfItsOwnContrastStaysAndTheSpecklesGo) {
  Picture p = grey_picture(240, 240, 0.5f);
  add_speckles(&p, 1500, 0.15);
  add_step(&p, 0.15);
  const EdgelMap all = detect_edges(p, everything()), kept = detect_edges(p, {});
  ASSERT_GT(all.edgels.size(), 3000u);
  EXPECT_GE(on_step(kept), 0.8 * 240 * 1.04);
  EXPECT_LE(kept.edgels.size() - on_step(kept), 0.05 * all.edgels.size());
}

// Grooves of a pitch [px] along rows, from row 20 to 220.
void add_grooves(Picture* p, double pitch, double height) {
  for (int y = 20; y < 220; ++y)
    for (int x = 0; x < p->width(); ++x) add(p, x, y, height * std::sin(2 * M_PI * y / pitch));
}

TEST(Meaningful, LayersOfAPrintGoAndAnEdgeAcrossThemStays) {
  for (const double pitch : {6.0, 7.0, 8.5}) {
    Picture p = grey_picture(240, 240, 0.5f);
    add_grooves(&p, pitch, 0.02);
    add_step(&p, 0.15);
    add_noise(&p, 2.0 / 255);
    const EdgelMap all = detect_edges(p, everything()), kept = detect_edges(p, {});
    ASSERT_GT(all.edgels.size() - on_step(all), 5000u);
    EXPECT_GE(on_step(kept), 0.8 * 240 * 1.04) << pitch;
    EXPECT_LE(kept.edgels.size() - on_step(kept), 0.05 * all.edgels.size()) << pitch;
  }
}

TEST(Meaningful, FinsOfSixteenPixelsStay) {
  Picture p = grey_picture(240, 240, 0.5f);
  add_grooves(&p, 16, 0.1);
  add_noise(&p, 2.0 / 255);
  const EdgelMap kept = detect_edges(p, {});
  EXPECT_GE(kept.edgels.size(), 0.95 * 240 * 2 * 200 / 16);
}

TEST(Meaningful, WhatNoiseMakesAtALowThresholdGoes) {
  Picture p = grey_picture(300, 300, 0.5f);
  add_noise(&p, 4.0 / 255);
  DetectOptions low = everything();
  low.high_sigma = low.low_sigma = 2;
  ASSERT_GT(detect_edges(p, low).edgels.size(), 1500u);
  low.meaning.most_false = 1;
  EXPECT_LE(detect_edges(p, low).num_chains(), 10);
}

TEST(Meaningful, SmallHolesOfACleanPictureStay) {
  for (const double radius : {4.0, 6.0, 10.0}) {
    Picture p = grey_picture(200, 200, 0.5f);
    for (int k = 0; k < 4; ++k) add_disk(&p, 40 + 40 * k, 60 + 20 * k, radius, -0.1);
    add_noise(&p, 2.0 / 255);
    EXPECT_EQ(detect_edges(p, {}).edgels.size(), detect_edges(p, everything()).edgels.size())
        << radius;
  }
}

TEST(Meaningful, ChainsAreNumberedAndNoneIsLessMeaningfulThanAllowed) {
  Picture p = grey_picture(240, 240, 0.5f);
  add_speckles(&p, 1500, 0.15);
  add_step(&p, 0.15);
  for (const double most : {1.0, 1e4}) {
    DetectOptions options;
    options.meaning.most_false = most;
    const EdgelMap map = detect_edges(p, options);
    ASSERT_EQ(int(map.meaning.size()), map.num_chains());
    for (const float m : map.meaning) EXPECT_GE(m, -std::log10(most));
  }
}

TEST(Meaningful, ABudgetKeepsTheLongSmoothEdgeFirst) {
  Picture p = grey_picture(240, 240, 0.5f);
  add_speckles(&p, 1500, 0.15);
  add_step(&p, 0.15);
  const EdgelMap map = most_meaningful(detect_edges(p, {}), 480);
  EXPECT_LE(map.edgels.size(), 480u);
  EXPECT_GE(on_step(map), 0.8 * 240 * 1.04);
}

TEST(Meaningful, TheUsualBudgetHoldsAFacadeOfSixtyWindows) {
  constexpr int kColumns = 12, kRows = 5, kWide = 40, kHigh = 56;
  Picture p = grey_picture(800, 600, 0.3f);
  for (int column = 0; column < kColumns; ++column)
    for (int row = 0; row < kRows; ++row)
      for (int y = 0; y < kHigh; ++y)
        for (int x = 0; x < kWide; ++x) add(&p, 15 + 65 * column + x, 10 + 118 * row + y, 0.3);
  add_noise(&p, 1.0 / 255);
  const EdgelMap all = detect_edges(p, {});
  ASSERT_GT(all.edgels.size(), 0.9 * kColumns * kRows * 2 * (kWide + kHigh));
  const double side = std::sqrt(800.0 * 600);
  EXPECT_EQ(most_meaningful(all, MeaningOptions().most_sides * side).edgels.size(),
            all.edgels.size());
}

// The outline, whose contrast the mask makes, is much of what lies around an edge on a rod.
TEST(Meaningful, AShortEdgeOnARodStaysHoweverStrongTheOutlineIs) {
  constexpr int kEdge = 120, kLength = 12;
  for (const double contrast : {0.05, 0.08, 0.12}) {
    Picture p = grey_picture(160, 240, 0.5f);
    for (int x = 80 - kLength / 2; x < 80 + kLength / 2; ++x)
      for (int y = kEdge; y < kEdge + 4; ++y) add(&p, x, y, contrast);
    add_speckles(&p, 300, 0.03);
    p.alpha = Image<float>(160, 240, 0.f);
    for (int y = 40; y < 200; ++y)
      for (int x = 60; x < 100; ++x) p.alpha.at(x, y) = 1;
    int on_edge = 0;
    for (const Edgel& e : detect_edges(p, {}).edgels)
      on_edge += !e.outline && std::abs(e.y - kEdge + 0.5) < 1.5 && std::abs(e.x - 79.5) < 6;
    EXPECT_GE(on_edge, 0.8 * kLength) << contrast;
  }
}

// Where colours told it from a table, alpha holds some of the table, too, and the object's outline
// is contrast of the picture.
TEST(Meaningful, AShortEdgeOnARodStaysIfAlphaReachesBeyondTheRod) {
  constexpr int kEdge = 120, kLength = 12, kBeyond = 10;
  int on_edge[2] = {};
  for (const bool known : {false, true}) {
    Picture p = grey_picture(160, 240, 0.5f);
    for (int y = 0; y < 240; ++y)
      for (int x = 0; x < 160; ++x)
        if (x < 60 || x >= 100) add(&p, x, y, 0.2 + 0.1 * ((x * 7 + y * 13) % 5 > 2));
    for (int x = 80 - kLength / 2; x < 80 + kLength / 2; ++x)
      for (int y = kEdge; y < kEdge + 4; ++y) add(&p, x, y, 0.05);
    add_speckles(&p, 300, 0.03);
    p.alpha = Image<float>(160, 240, 0.f);
    for (int y = 40; y < 200; ++y)
      for (int x = 60 - kBeyond; x < 100 + kBeyond; ++x) p.alpha.at(x, y) = 1;
    if (known) p.beyond_px = kBeyond;
    for (const Edgel& e : detect_edges(p, {}).edgels)
      on_edge[known] += std::abs(e.y - kEdge + 0.5) < 1.5 && std::abs(e.x - 79.5) < kLength / 2;
  }
  EXPECT_GE(on_edge[true], 0.8 * kLength);
  EXPECT_LT(on_edge[false], 0.5 * kLength) << "else this tests nothing";
}

TEST(Meaningful, AnEmptyMapStaysEmpty) {
  EdgelMap map;
  map.width = map.height = 20;
  keep_meaningful(cv::Mat1f::zeros(20, 20), cv::Mat1b::zeros(20, 20), {}, &map);
  EXPECT_EQ(map.num_chains(), 0);
}

TEST(Lookup, FarPixelsKnowHowFarTheNearestEdgelIsAtLeast) {
  Picture p = grey_picture(120, 90, 0.5f);
  add_disk(&p, 40, 50, 12, 0.3);
  EdgelMap map = detect_edges(p, {});
  build_lookup(&map);
  const auto is_free = [&](int x, int y) { return map.nearest_at(x, y) < 0; };
  for (int y = -30; y < 130; y += 7)
    for (int x = -30; x < 160; x += 7) {
      const int far = -map.nearest_or_far(x, y);
      if (!is_free(x, y)) continue;
      ASSERT_GE(far, 1);
      int nearest = 1;  // chessboard, by looking
      for (bool free = true; nearest < 200; ++nearest) {
        for (int d = -nearest; d <= nearest && free; ++d)
          free = is_free(x + d, y - nearest) && is_free(x + d, y + nearest) &&
                 is_free(x - nearest, y + d) && is_free(x + nearest, y + d);
        if (!free) break;
      }
      EXPECT_LE(far, nearest) << x << " " << y;
      if (x >= map.x0 && y >= map.y0 && x < map.x0 + map.window_width &&
          y < map.y0 + map.window_height) {
        EXPECT_EQ(far, nearest) << x << " " << y;
      }
    }
}

}  // namespace
}  // namespace sketchsplat
