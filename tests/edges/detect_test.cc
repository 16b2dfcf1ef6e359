// SPDX-License-Identifier: MIT
#include "edges/image/detect.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "edges/image/detect_map.h"

namespace sketchsplat {
namespace {

// Area of a pixel on the bright side of the line n.p = c, by supersampling.
double coverage(double nx, double ny, double c, int x, int y) {
  int inside = 0;
  for (int i = 0; i < 16; ++i)
    for (int j = 0; j < 16; ++j)
      inside += nx * (x + (i - 7.5) / 16) + ny * (y + (j - 7.5) / 16) > c;
  return inside / 256.0;
}

Picture grey_picture(int w, int h) {
  Picture p;
  p.red = p.green = p.blue = Image<float>(w, h, 0.f);
  return p;
}

void set(Picture* p, int x, int y, double v) {
  p->red.at(x, y) = p->green.at(x, y) = p->blue.at(x, y) = float(v);
}

Picture step_picture(double angle_deg, double dark, double bright, double noise = 0) {
  Picture p = grey_picture(64, 64);
  const double nx = std::cos(angle_deg * M_PI / 180), ny = std::sin(angle_deg * M_PI / 180);
  std::mt19937 rng(7);
  std::normal_distribution<double> normal(0, 1);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      set(&p, x, y,
          dark + (bright - dark) * coverage(nx, ny, nx * 31.3 + ny * 30.6, x, y) +
              noise * normal(rng));
  return p;
}

TEST(Detect, FindsAStraightStepToAFewHundredthsOfAPixelAtAnyAngle) {
  for (double angle = 0; angle < 360; angle += 17) {
    const EdgelMap map = detect_edges(step_picture(angle, 0.4, 0.6), {});
    const double nx = std::cos(angle * M_PI / 180), ny = std::sin(angle * M_PI / 180);
    double sum = 0, squares = 0;
    int n = 0;
    for (const Edgel& e : map.edgels) {
      if (e.x < 8 || e.y < 8 || e.x > 55 || e.y > 55) continue;
      const double d = nx * (e.x - 31.3) + ny * (e.y - 30.6);
      sum += d, squares += d * d, ++n;
      EXPECT_GT(nx * e.nx + ny * e.ny, 0.999) << "normals point to the bright side";
      EXPECT_NEAR(e.width, 1.05, 0.1);
    }
    ASSERT_GE(n, 40) << angle;
    // Along the pixel grid every edgel carries the same error of sampling; elsewhere it averages
    // out.
    EXPECT_LT(std::abs(sum / n), angle == 0 ? 0.06 : 0.01) << angle;
    EXPECT_LT(std::sqrt(squares / n), angle == 0 ? 0.06 : 0.03) << angle;
  }
}

TEST(Detect, ChainsAStraightStepIntoOneRun) {
  const EdgelMap map = detect_edges(step_picture(30, 0.4, 0.6), {});
  ASSERT_EQ(map.num_chains(), 1);
  EXPECT_EQ(map.chain.back(), int(map.edgels.size()));
}

TEST(Detect, NoiseAloneGivesNextToNothingWhateverItsStrength) {
  for (double noise : {0.5 / 255, 2.0 / 255, 4.0 / 255, 10.0 / 255}) {
    const EdgelMap map = detect_edges(step_picture(0, 0.5, 0.5, noise), {});
    EXPECT_NEAR(map.noise, noise, 0.25 * noise);
    EXPECT_LE(map.edgels.size(), 12u) << noise * 255;
  }
}

TEST(Detect, AWeakStepInNoiseIsFound) {
  const EdgelMap map = detect_edges(step_picture(70, 0.45, 0.55, 3.0 / 255), {});
  int near = 0;
  for (const Edgel& e : map.edgels)
    near += std::abs(std::cos(70 * M_PI / 180) * (e.x - 31.3) +
                     std::sin(70 * M_PI / 180) * (e.y - 30.6)) < 0.5;
  EXPECT_GE(near, 45);
}

TEST(Detect, TheOutlineIsWhereAlphaSaysWhateverColourHidesBehindIt) {
  for (float hidden : {0.f, 0.5f, 1.f}) {
    Picture p = grey_picture(64, 64);
    p.alpha = Image<float>(64, 64, 0.f);
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) {
        const double a = coverage(1, 0, 20.3, x, y) - coverage(1, 0, 44.7, x, y);
        p.alpha.at(x, y) = float(a);
        set(&p, x, y, a > 0 ? 0.8 : hidden);
      }
    const EdgelMap map = detect_edges(p, {});
    ASSERT_GE(map.edgels.size(), 100u);
    for (const Edgel& e : map.edgels) {
      if (e.y < 6 || e.y > 57) continue;
      EXPECT_LT(std::min(std::abs(e.x - 20.3), std::abs(e.x - 44.7)), 0.06) << hidden;
    }
  }
}

TEST(Detect, TheFrameOfTheImageIsNoOutline) {
  Picture p = grey_picture(40, 40);
  p.alpha = Image<float>(40, 40, 1.f);
  EXPECT_TRUE(detect_edges(p, {}).edgels.empty()) << "opaque all over";
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 20; ++x) p.alpha.at(x, y) = 0;
  const EdgelMap map = detect_edges(p, {});
  EXPECT_GE(map.edgels.size(), 30u);
  for (const Edgel& e : map.edgels) EXPECT_NEAR(e.x, 19.5, 0.1) << "the object ends here alone";
}

TEST(Detect, EmptyFlatAndTransparentPicturesGiveNoEdgels) {
  EXPECT_TRUE(detect_edges({}, {}).edgels.empty());
  EXPECT_TRUE(detect_edges(grey_picture(1, 1), {}).edgels.empty());
  EXPECT_TRUE(detect_edges(grey_picture(64, 64), {}).edgels.empty());
  Picture clear = grey_picture(64, 64);
  clear.alpha = Image<float>(64, 64, 0.f);
  set(&clear, 10, 10, 1);
  EXPECT_TRUE(detect_edges(clear, {}).edgels.empty());
}

TEST(Detect, LookupAgreesWithTheObviousSearch) {
  EdgelMap map = detect_edges(step_picture(25, 0.3, 0.7), {});
  build_lookup(&map);
  for (int y = 0; y < 64; y += 2)
    for (int x = 0; x < 64; ++x) {
      double best = 1e9;
      for (const Edgel& e : map.edgels) best = std::min(best, double(std::hypot(e.x - x, e.y - y)));
      const int k = map.nearest_at(x, y);
      if (best < 3.9) {
        ASSERT_GE(k, 0) << x << " " << y;
        EXPECT_NEAR(std::hypot(map.edgels[k].x - x, map.edgels[k].y - y), best, 1e-5);
      } else if (best > 4.1) {
        EXPECT_EQ(k, -1);
      }
    }
}

TEST(Detect, DrawnMapIsOneOnTheEdgeAndZeroFarFromIt) {
  const EdgelMap map = detect_edges(step_picture(0, 0.3, 0.7), {});
  const Image<float> drawn = draw_edge_map(map, 0.7);
  EXPECT_GT(drawn.at(31, 32), 0.85f);
  EXPECT_EQ(drawn.at(10, 32), 0.f);
  for (float v : drawn.data) EXPECT_TRUE(v >= 0 && v <= 1);
}

// A thick ridge as networks draw it.
Image<float> ridge_map(double angle_deg, double sigma, bool inverted) {
  Image<float> m(64, 64);
  const double nx = std::cos(angle_deg * M_PI / 180), ny = std::sin(angle_deg * M_PI / 180);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const double d = nx * (x - 31.3) + ny * (y - 30.6);
      const double v = 0.9 * std::exp(-0.5 * d * d / (sigma * sigma));
      m.at(x, y) = float(inverted ? 1 - v : v);
    }
  return m;
}

TEST(DetectRidges, LocalisesAThickRidgeOfEitherPolarity) {
  for (bool inverted : {false, true})
    for (double angle = 0; angle < 180; angle += 23) {
      const EdgelMap map = detect_ridges(ridge_map(angle, 1.8, inverted), {});
      const double nx = std::cos(angle * M_PI / 180), ny = std::sin(angle * M_PI / 180);
      int n = 0;
      for (const Edgel& e : map.edgels) {
        if (e.x < 6 || e.y < 6 || e.x > 57 || e.y > 57) continue;
        ++n;
        EXPECT_LT(std::abs(nx * (e.x - 31.3) + ny * (e.y - 30.6)), 0.06);
        EXPECT_GT(std::abs(nx * e.nx + ny * e.ny), 0.99);
      }
      EXPECT_GE(n, 45) << angle << inverted;
    }
}

TEST(DetectRidges, FlatAndEmptyMapsGiveNothing) {
  EXPECT_TRUE(detect_ridges({}, {}).edgels.empty());
  EXPECT_TRUE(detect_ridges(Image<float>(32, 32, 0.f), {}).edgels.empty());
  EXPECT_TRUE(detect_ridges(Image<float>(32, 32, 1.f), {}).edgels.empty());
}

}  // namespace
}  // namespace sketchsplat
