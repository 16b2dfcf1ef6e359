// SPDX-License-Identifier: MIT
// Silhouettes told by colours: of a ball before a blotched background, so that each is a disc and
// known exactly.
#include "edges/views/silhouettes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "datasets/types/errors.h"
#include "edges/image/cut_out.h"
#include "tests/support/strokes.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector2d;
using Eigen::Vector3d;

const Vector3d kMiddle(0.5, 0.5, 0.5);
constexpr double kRadius = 0.3;

const Vector3d kBeside = kMiddle + Vector3d(0.55, 0, 0);  // where another, smaller one may lie
constexpr double kSmaller = 0.1;

// Does the line of sight through a pixel meet the ball?
bool on_ball(const View& view, double x, double y, const Vector3d& middle = kMiddle,
             double radius = kRadius) {
  const Vector3d ray =
      view.cam_from_world.rotation.transpose() * view.camera.ray({x, y}).normalized();
  return ray.cross(middle - view.center_in_world()).norm() < radius;
}

// Orange on grey and brown blotches, with noise, as `denominator` pixels seen as one.
Picture photograph(const View& view, int denominator, bool ball, unsigned seed,
                   bool beside = false) {
  const Camera camera = view.camera.shrunk(denominator);
  Picture out;
  for (Image<float>* c : {&out.red, &out.green, &out.blue})
    *c = Image<float>(camera.width, camera.height);
  std::mt19937 rng(seed);
  std::normal_distribution<float> noise(0, 0.02f);
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const double u = denominator * (x + 0.5) - 0.5, v = denominator * (y + 0.5) - 0.5;
      const bool brown = std::sin(0.05 * u) * std::cos(0.07 * v) > 0.2;
      const bool orange =
          (ball && on_ball(view, u, v)) || (beside && on_ball(view, u, v, kBeside, kSmaller));
      out.red.at(x, y) = (orange ? 0.9f : brown ? 0.45f : 0.5f) + noise(rng);
      out.green.at(x, y) = (orange ? 0.5f : brown ? 0.3f : 0.5f) + noise(rng);
      out.blue.at(x, y) = (orange ? 0.2f : brown ? 0.2f : 0.5f) + noise(rng);
    }
  return out;
}

ObjectRegion around_ball() {
  ObjectRegion region;
  region.box = {kMiddle - Vector3d::Constant(kRadius + 0.02),
                kMiddle + Vector3d::Constant(kRadius + 0.02)};
  return region;
}

Silhouettes found(const std::vector<View>& views, const std::vector<int>& blind) {
  return find_silhouettes(views, around_ball(), [&](int v, int denominator) {
    const bool ball = std::find(blind.begin(), blind.end(), v) == blind.end();
    return photograph(views[size_t(v)], denominator, ball, unsigned(v));
  });
}

TEST(CutOut, ColoursTellADiscFromBlotches) {
  const View view = ring_of_views(3, kMiddle, 3)[0];
  const Picture picture = photograph(view, 2, true, 1);
  Image<uint8_t> maybe(picture.width(), picture.height());
  int right = 0, disc = 0, cut = 0;
  const auto truly = [&](int x, int y) { return on_ball(view, 2 * x + 0.5, 2 * y + 0.5); };
  const int margin = 12;
  for (int y = margin; y + margin < maybe.height; ++y)
    for (int x = margin; x + margin < maybe.width; ++x)
      for (const auto& [u, v] : {std::pair(-margin, 0), {margin, 0}, {0, -margin}, {0, margin}})
        maybe.at(x, y) |= truly(x + u, y + v) || truly(x, y);
  const Image<uint8_t> out = cut_out({&picture}, {maybe}, 3)[0];
  ASSERT_FALSE(out.empty());
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      disc += truly(x, y), cut += out.at(x, y);
      right += truly(x, y) && out.at(x, y);
    }
  EXPECT_GT(disc, 1000);
  EXPECT_GT(right, 0.97 * disc);
  EXPECT_LT(cut, 1.03 * disc);
  EXPECT_EQ(cut_out({&picture}, {maybe}, 3)[0].data, out.data) << "nothing is left to chance";
}

// A grey disc on brown; where it may be lie three things of colours that are nowhere else.
TEST(CutOut, ThingsBesideTheObjectAreCutOffWhereTheObjectIsLikelyToBeElsewhere) {
  constexpr int kSide = 160, kDisc = 30;
  Picture picture;
  for (Image<float>* c : {&picture.red, &picture.green, &picture.blue})
    *c = Image<float>(kSide, kSide);
  std::mt19937 rng(3);
  std::normal_distribution<float> noise(0, 0.02f);
  const auto of_disc = [&](int x, int y) { return std::hypot(x - 70, y - 80) < kDisc; };
  const auto thing = [&](int x, int y) { return x >= 108 && x < 124 ? (y - 50) / 22 : -1; };
  Image<uint8_t> maybe(kSide, kSide);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const bool disc = of_disc(x, y);
      const int other = y >= 50 && y < 116 ? thing(x, y) : -1;
      picture.red.at(x, y) = (disc ? 0.45f : other == 0 ? 0.9f : 0.5f) + noise(rng);
      picture.green.at(x, y) = (disc ? 0.45f : other == 1 ? 0.8f : 0.3f) + noise(rng);
      picture.blue.at(x, y) = (disc ? 0.45f : other == 2 ? 0.9f : 0.15f) + noise(rng);
      maybe.at(x, y) = x > 30 && x < 128 && y > 40 && y < 122;
    }
  Image<uint8_t> likely = maybe;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) likely.at(x, y) += std::hypot(x - 68, y - 82) < kDisc;
  int of_things[2] = {}, of_object[2] = {}, disc = 0;
  for (const bool told : {false, true}) {
    const Image<uint8_t> out = cut_out({&picture}, {told ? likely : maybe}, 2)[0];
    ASSERT_FALSE(out.empty());
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        disc += told && of_disc(x, y);
        of_object[told] += of_disc(x, y) && out.at(x, y);
        of_things[told] += y >= 50 && y < 116 && thing(x, y) >= 0 && out.at(x, y);
      }
  }
  EXPECT_GT(of_object[true], 0.97 * disc);
  EXPECT_LT(of_things[true], 0.03 * disc);
  EXPECT_GT(of_things[false], 0.2 * disc) << "else this tests nothing";
}

TEST(CutOut, WithoutSurroundingsNothingIsTold) {
  const View view = ring_of_views(3, kMiddle, 3)[0];
  const Picture picture = photograph(view, 4, true, 1);
  const int w = picture.width(), h = picture.height();
  EXPECT_TRUE(cut_out({&picture}, {Image<uint8_t>(w, h, 1)}, 3)[0].empty());
  EXPECT_TRUE(cut_out({&picture}, {Image<uint8_t>(w, h, 0)}, 3)[0].empty());
}

// Half orange, half blue; the first picture's guess of where it is likely to be lacks the blue
// half.
TEST(CutOut, AFaceThatOnePictureTakesForItsSurroundingsIsToldByTheOthers) {
  constexpr int kSide = 120, kDisc = 30, kViews = 4;
  std::mt19937 rng(5);
  std::normal_distribution<float> noise(0, 0.02f);
  std::vector<Picture> pictures(kViews);
  std::vector<Image<uint8_t>> maybe(kViews, Image<uint8_t>(kSide, kSide));
  for (int k = 0; k < kViews; ++k) {
    for (Image<float>* c : {&pictures[k].red, &pictures[k].green, &pictures[k].blue})
      *c = Image<float>(kSide, kSide);
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const double from_middle = std::hypot(x - 60, y - 60);
        const bool disc = from_middle < kDisc, blue = disc && x > 60;
        pictures[k].red.at(x, y) = (blue ? 0.3f : disc ? 0.9f : 0.5f) + noise(rng);
        pictures[k].green.at(x, y) = (disc ? 0.5f : 0.35f) + noise(rng);
        pictures[k].blue.at(x, y) = (blue ? 0.9f : 0.2f) + noise(rng);
        const bool likely = disc && (k > 0 || !blue);
        maybe[k].at(x, y) = likely ? 2 : from_middle < kDisc + 12 ? 1 : 0;
      }
  }
  const auto share_of_blue = [&](const Image<uint8_t>& cut) {
    int blue = 0, held = 0;
    for (int y = 0; y < kSide; ++y)
      for (int x = 62; x < kSide; ++x)
        if (std::hypot(x - 60, y - 60) < kDisc) ++blue, held += cut.at(x, y);
    return double(held) / blue;
  };
  EXPECT_LT(share_of_blue(cut_out({&pictures[0]}, {maybe[0]}, 3)[0]), 0.5) << "alone";
  std::vector<const Picture*> all;
  for (const Picture& p : pictures) all.push_back(&p);
  EXPECT_GT(share_of_blue(cut_out(all, maybe, 3)[0]), 0.95);
  maybe[1] = {};
  EXPECT_TRUE(cut_out(all, maybe, 3)[1].empty()) << "it is left out";
}

TEST(Silhouettes, HoldTheObjectAndLittleMore) {
  const std::vector<View> views = ring_of_views(10, kMiddle, 3);
  const Silhouettes s = found(views, {});
  ASSERT_EQ(s.mask.size(), views.size());
  EXPECT_EQ(s.trusted, 10);
  EXPECT_GT(s.agreement, 0.9);
  for (size_t v = 0; v < views.size(); ++v) {
    int disc = 0, missed = 0, beside = 0;
    for (int y = 0; y < s.mask[v].height; ++y)
      for (int x = 0; x < s.mask[v].width; ++x) {
        const bool truth = on_ball(views[v], x, y), mask = s.mask[v].at(x, y);
        disc += truth, missed += truth && !mask, beside += mask && !truth;
      }
    EXPECT_LT(missed, 0.01 * disc) << v;
    const double circumference = 2 * std::sqrt(M_PI * disc);
    EXPECT_LT(beside, 1.5 * s.slack_px[v] * circumference) << v;
  }
  for (const Vector3d& axis : {Vector3d(1, 0, 0), Vector3d(0, 1, 0)})
    for (const double side : {-0.9, 0.9})
      EXPECT_TRUE(s.region.contains(kMiddle + side * kRadius * axis));
}

TEST(Silhouettes, APictureThatShowsSomethingElseIsNotTrustedAndCarvesNothing) {
  const std::vector<View> views = ring_of_views(12, kMiddle, 3);
  const Silhouettes s = found(views, {4});
  ASSERT_EQ(s.mask.size(), views.size());
  EXPECT_TRUE(s.mask[4].empty());
  EXPECT_EQ(s.trusted, 11);
  EXPECT_TRUE(s.region.contains(kMiddle + Vector3d(0.9 * kRadius, 0, 0)));
}

TEST(Silhouettes, WhatStandsBesideTheObjectIsNoneOfItWhateverItsColours) {
  const std::vector<View> views = ring_of_views(12, kMiddle, 3);
  ObjectRegion region = around_ball();
  region.box.extend(kBeside + Vector3d::Constant(kSmaller + 0.02));
  for (int k = 0; k < 20; ++k)
    region.edges.push_back(kMiddle + 0.95 * kRadius * Vector3d(std::cos(k), std::sin(k), 0));
  for (int k = 0; k < 5; ++k)  // a fifth of the edges that are known are not the object's
    region.edges.push_back(kBeside + 0.9 * kSmaller * Vector3d(std::cos(k), std::sin(k), 0));
  const Silhouettes s = find_silhouettes(views, region, [&](int v, int denominator) {
    return photograph(views[size_t(v)], denominator, true, unsigned(v), true);
  });
  ASSERT_EQ(s.mask.size(), views.size());
  EXPECT_TRUE(s.region.contains(kMiddle + Vector3d(0.9 * kRadius, 0, 0)));
  EXPECT_FALSE(s.region.contains(kBeside));
}

TEST(Silhouettes, WhereManyPicturesDisagreeNothingIsKnown) {
  const std::vector<View> views = ring_of_views(12, kMiddle, 3);
  EXPECT_TRUE(found(views, {0, 2, 4, 6, 8, 10, 11}).mask.empty());
  const auto none = [](int, int) -> Picture { throw InputError("a.jpg", "a picture", "none"); };
  EXPECT_TRUE(find_silhouettes(views, around_ball(), none).mask.empty());
  EXPECT_TRUE(find_silhouettes(views, ObjectRegion(), none).mask.empty());
}

TEST(Silhouettes, OfAnObjectThatNoPictureShowsWholeNothingIsKnown) {
  std::vector<View> views = ring_of_views(10, kMiddle, 3);
  ASSERT_FALSE(found(views, {}).mask.empty());
  const View whole = views[0];
  for (View& view : views) view.camera.height /= 2;  // the upper half of each picture alone
  EXPECT_TRUE(found(views, {}).mask.empty());
  views[0] = whole;
  EXPECT_FALSE(found(views, {}).mask.empty()) << "one tells where it ends";
}

TEST(Silhouettes, ThatLeaveOutEdgesOfTheObjectAreNone) {
  const std::vector<View> views = ring_of_views(10, kMiddle, 3);
  ObjectRegion region = around_ball();
  const auto read = [&](int v, int denominator) {
    return photograph(views[size_t(v)], denominator, true, unsigned(v));
  };
  for (int k = 0; k < 20; ++k)
    region.edges.push_back(kMiddle + 0.95 * kRadius * Vector3d(std::cos(k), std::sin(k), 0));
  EXPECT_FALSE(find_silhouettes(views, region, read).mask.empty());
  for (int k = 0; k < 4; ++k)
    region.edges.push_back(kMiddle + kRadius * Vector3d(1, 1, 1 - 0.1 * k));
  EXPECT_TRUE(find_silhouettes(views, region, read).mask.empty());
}

// A circle around the ball is its outline, one inside is not, and one beside it is no edge of it.
TEST(Silhouettes, StandInForMasks) {
  const std::vector<View> views = ring_of_views(10, kMiddle, 3);
  const Silhouettes s = found(views, {});
  std::vector<EdgelMap> maps;
  for (const View& view : views)
    maps.push_back(ideal_edgels(view, cube_edges({0.4, 0.4, 0.4}, 0.2)));
  const EdgeWorld before = make_edge_world(views, maps);
  EXPECT_TRUE(before.hull.empty());
  const EdgeWorld after = with_silhouettes(before, s);
  EXPECT_FALSE(after.hull.empty());
  EXPECT_FALSE(after.has_masks()) << "they are not exact";
  for (size_t v = 0; v < views.size(); ++v) {
    EXPECT_EQ(after.maps[v].edgels.size(), before.maps[v].edgels.size());
    EXPECT_EQ(after.plane_normal[v].cols(), Eigen::Index(after.maps[v].edgels.size()));
    for (const Edgel& e : after.maps[v].edgels) EXPECT_FALSE(e.outline);
  }
  maps.clear();
  for (const View& view : views)
    maps.push_back(ideal_edgels(view, cube_edges({1.0, 0.4, 0.4}, 0.2)));
  const EdgeWorld beside = with_silhouettes(make_edge_world(views, maps), s);
  for (size_t v = 0; v < views.size(); ++v)
    for (const Edgel& e : beside.maps[v].edgels) {
      const Vector2d p(e.x, e.y);
      EXPECT_TRUE(s.mask[v].at(int(std::lround(p.x())), int(std::lround(p.y()))));
    }
}

}  // namespace
}  // namespace sketchsplat
