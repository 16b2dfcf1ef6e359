// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "pipelines/method/rounds.h"
#include "pipelines/options/derived_options.h"
#include "pipelines/survey/observe.h"
#include "tests/support/strokes.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;
const Vector3d kMiddle(0.5, 0.5, 0.5);

EdgeWorld cube_world() {
  return ideal_world(ring_of_views(12, kMiddle, 3), cube_edges({0.2, 0.2, 0.2}, 0.6));
}

// The first `count` edges of the cube.
Sketch cube_sketch(size_t count) {
  Sketch s;
  const std::vector<Polyline> edges = cube_edges({0.2, 0.2, 0.2}, 0.6);
  for (size_t i = 0; i < std::min(count, edges.size()); ++i)
    add_line(&s, edges[i].front(), edges[i].back());
  return s;
}

TEST(StrokeStages, ASecondLookFindsTheEdgesThatTheFirstOneLacks) {
  const EdgeWorld world = cube_world();
  ReconstructOptions options;
  options.rounds = 0;
  RunReport report;
  const MethodRun run{options, {&report}};
  const Sketch all = Rounds(world, {}, run).second_look(cube_sketch(9));
  ASSERT_EQ(all.size(), 12);
  const std::vector<Polyline> truth = cube_edges({0.2, 0.2, 0.2}, 0.6);
  for (int s = 9; s < 12; ++s)
    for (const double t : {0.2, 0.5, 0.8})
      EXPECT_LT(distance_to({truth.begin() + 9, truth.end()}, point_at(all, s, t)), 0.003);
  options.second_look = false;
  EXPECT_EQ(Rounds(world, {}, run).second_look(cube_sketch(9)).size(), 9);
}

TEST(StrokeStages, RegularitiesAreWeighedAsTheProductDescribes) {
  ReconstructOptions options;
  options.segment.price = 7;
  options.rechain.sigma_px = 0.4;
  options.polish.smooth_deg = 20;
  options.polish.smooth_sigma_deg = 3;
  options.regularize.soft_px = 0.07;
  const RegularizeOptions made = regularize_options(options);
  EXPECT_EQ(made.price, 7);
  EXPECT_EQ(made.sigma_px, 0.4);
  EXPECT_EQ(made.soft_px, 0.07);
  EXPECT_NEAR(made.refine.smooth_angle, 20 * M_PI / 180, 1e-12);
  EXPECT_NEAR(made.refine.smooth_weight, std::pow(180 / (0.3 * M_PI), 2), 1e-6);
}

TEST(Observe, ANodeCostsTheLogarithmOfThePlacesThatItMayTake) {
  EdgeWorld world;
  EXPECT_EQ(node_price(world, 0.2), 0) << "nowhere to be";
  world.bounds = {Vector3d(0, 0, 0), Vector3d(2, 3, 6)};  // diagonal 7
  world.footprint = 0.01;
  EXPECT_NEAR(node_price(world, 0.2), 3 * std::log(700 / 0.2), 1e-9);
  EXPECT_EQ(node_price(world, 1e6), 0) << "never less than nothing";
}

TEST(Observe, AStrokeLiesAsWellAsHalfOfWhatEdgelsScatterButNotBetterThanIsSaid) {
  Observation o;
  o.matches.sigma_px = 0.6;
  EXPECT_EQ(place_sigma_px(o, 0.2), 0.3);
  EXPECT_EQ(place_sigma_px(o, 0.5), 0.5);
}

TEST(Observe, EverySampleOfAnEdgeMeetsItsEdgelInEveryView) {
  const EdgeWorld world = cube_world();
  MatchOptions match;
  match.reach_px = 1;
  const Observation o = observe(cube_sketch(12), world, match, 3);
  const int samples = int(o.samples.position.cols());
  ASSERT_EQ(o.matches.first.size(), size_t(samples) + 1);
  EXPECT_GT(double(o.matches.matches.size()), 0.97 * 12 * samples);
  for (const SampleMatch& m : o.matches.matches) {
    double depth;
    const Edgel& e = world.maps[m.view].edgels[m.edgel];
    const Eigen::Vector2d p = world.views[m.view].project(o.samples.position.col(m.sample), &depth);
    EXPECT_NEAR((p.x() - e.x) * e.nx + (p.y() - e.y) * e.ny, m.distance_px, 1e-3);
  }
  const Observation none = observe(moved(cube_sketch(12), {0.05, 0.03, 0.04}), world, match, 3);
  EXPECT_LT(none.matches.matches.size(), o.matches.matches.size() / 4);
}

}  // namespace
}  // namespace sketchsplat
