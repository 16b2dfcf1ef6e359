// SPDX-License-Identifier: MIT
#include "pipelines/survey/likelihood.h"

#include <gtest/gtest.h>

#include "edges/views/unexplained.h"
#include "tests/support/strokes.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;
const Vector3d kMiddle(0.5, 0.5, 0.5);
constexpr double kPixel = 3.0 / 500;
constexpr double kReach = 1;

// Lines of a cube, which all views see, and one that only some do.
struct Scene {
  Sketch sketch;
  int rare = 0;
  EdgeWorld world;
  Scene(int views, int seeing, double off_px = 0) {
    for (const Polyline& e : cube_edges({0.2, 0.2, 0.2}, 0.6)) add_line(&sketch, e[0], e[1]);
    rare = add_line(&sketch, {0.3, 0.5, 0.45}, {0.7, 0.55, 0.6});
    const std::vector<View> ring = ring_of_views(views, kMiddle, 3);
    std::vector<EdgelMap> maps;
    for (int i = 0; i < views; ++i) {
      std::vector<Polyline> seen = polylines_of(sketch);
      if (i >= seeing) seen.pop_back();
      // To this side in one view, to that in the next, as wrong cameras have it.
      for (Polyline& p : seen)
        for (Vector3d& x : p) x += (i % 2 ? 1 : -1) * off_px * kPixel * Vector3d(0.6, 0, 0.8);
      maps.push_back(ideal_edgels(ring[i], seen));
    }
    world = make_edge_world(ring, maps);
  }
  Observation every(double reach_px = kReach) const {
    MatchOptions match;
    match.exclusive = match.quadratics = false;
    match.min_run = 0;
    match.reach_px = reach_px;
    return observe(sketch, world, match, 2.0);
  }
};

double nats_of_rare(const Scene& s, const EdgelFlags* others = nullptr, double sigma_px = 0.1) {
  const Observation every = s.every();
  return StrokeJudge(s.world, every, kReach, sigma_px, {}).nats(s.rare, others);
}

TEST(Likelihood, EveryFurtherViewThatShowsAnEdgeMakesItLikelier) {
  double last = nats_of_rare(Scene(20, 0));
  EXPECT_LT(last, 0) << "nobody shows it";
  for (int seeing = 1; seeing <= 20; ++seeing) {
    const double nats = nats_of_rare(Scene(20, seeing));
    EXPECT_GT(nats, last) << seeing;
    last = nats;
  }
  EXPECT_GT(last, 15);
}

TEST(Likelihood, ViewsThatDoNotShowAnEdgeMakeItLessLikelyButNeverMuchWithoutAHull) {
  const double few = nats_of_rare(Scene(10, 8)), many = nats_of_rare(Scene(60, 8));
  EXPECT_GT(few, many);
  EXPECT_GT(many, 0) << "something may hide it from the others";
}

TEST(Likelihood, EdgelsOfOthersTellNothing) {
  const Scene s(20, 20);
  EdgelFlags all = no_edgels(s.world);
  for (auto& view : all) std::fill(view.begin(), view.end(), 1);
  EXPECT_LE(nats_of_rare(s, &all), 0);
  EXPECT_GT(nats_of_rare(s, nullptr), 15);
}

TEST(Likelihood, ScatterIsWhatTheCamerasErrAndTellsHowFarEdgelsCount) {
  EXPECT_LT(scatter_px(Scene(20, 20).world, Scene(20, 20).every(3)), 0.03);
  const Scene off(20, 20, 1);
  const double scatter = scatter_px(off.world, off.every(3));
  EXPECT_GT(scatter, 0.4);
  EXPECT_LT(scatter, 1.5);
  const Scene little(20, 20, 0.3);
  EXPECT_GT(nats_of_rare(little), 5) << "their scatter is that of the scene, whatever one says";
}

TEST(Likelihood, OfNothingIsNothing) {
  const std::vector<View> ring = ring_of_views(5, kMiddle, 3);
  const EdgeWorld blank = make_edge_world(ring, std::vector<EdgelMap>(5));
  Scene s(5, 5);
  s.world = blank;
  EXPECT_EQ(scatter_px(blank, s.every()), 0);
  EXPECT_LT(nats_of_rare(s), 0);
}

}  // namespace
}  // namespace sketchsplat
