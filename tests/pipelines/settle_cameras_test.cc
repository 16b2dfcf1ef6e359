// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "pipelines/cameras/bring_back.h"
#include "pipelines/cameras/posed.h"
#include "tests/support/house.h"
#include "tests/support/strokes.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;
constexpr int kViews = 16;

Sketch strokes_of(const std::vector<Polyline>& lines) {
  Sketch sketch;
  for (const Polyline& p : lines) add_line(&sketch, p[0], p[1]);
  return sketch;
}

// Shifted so that the object moves by so many pixels.
View shifted(View v, double dx, double dy) {
  const double depth = (v.cam_from_world * kHouseMiddle).z();
  v.cam_from_world.translation += Vector3d(dx * depth / v.camera.fx, dy * depth / v.camera.fy, 0);
  return v;
}

// Largest distance [px] of corners of the object in one camera and in another.
double apart_px(const View& a, const View& b) {
  double worst = 0, depth;
  for (const Polyline& p : house())
    worst = std::max(worst, (a.project(p[0], &depth) - b.project(p[0], &depth)).norm());
  return worst;
}

TEST(BringBack, AViewThatIsSixPixelsOffComesBackAndTheOthersStay) {
  const std::vector<View> truth = ring_of_views(kViews, kHouseMiddle, 3);
  std::vector<View> stated = truth;
  stated[5] = shifted(truth[5], 5, -3.5);
  EdgeWorld world = make_edge_world(stated, house_edgels(truth));
  EXPECT_EQ(bring_back(strokes_of(house()), {stated}, {}, &world), 1);
  EXPECT_LT(apart_px(world.views[5], truth[5]), 0.1);
  for (int v = 0; v < kViews; ++v)
    EXPECT_EQ(apart_px(world.views[v], v == 5 ? world.views[5] : stated[v]), 0) << v;
}

TEST(BringBack, NothingMovesWhereAllViewsFitOrNothingIsDrawn) {
  const std::vector<View> truth = ring_of_views(kViews, kHouseMiddle, 3);
  EdgeWorld world = make_edge_world(truth, house_edgels(truth));
  EXPECT_EQ(bring_back(strokes_of(house()), {truth}, {}, &world), 0);
  EXPECT_EQ(bring_back({}, {truth}, {}, &world), 0);
}

TEST(FitCameras, StrokesThatWanderFromViewToViewHardlyBendTheCameras) {
  const std::vector<View> truth = ring_of_views(kViews, kHouseMiddle, 3);
  std::vector<EdgelMap> maps = house_edgels(truth);
  constexpr int kWandering = 10;  // edges, all to one side in a view, as outlines of rounds do
  for (int v = 0; v < kViews; ++v) {
    EdgelMap& map = maps[v];
    const Eigen::Vector2d by(std::cos(2.4 * v), std::sin(2.4 * v));
    for (int i = 0; i < map.chain[kWandering]; ++i)
      map.edgels[i].x += float(by.x()), map.edgels[i].y += float(by.y());
    build_lookup(&map, 4.0);
  }
  const Sketch sketch = strokes_of(house());
  EdgeWorld world = make_edge_world(truth, maps);
  for (int k = 0; k < 4; ++k) {
    MatchOptions match;
    match.reach_px = 2;
    const Observation o = observe(sketch, world, match, 6);
    world.views = fit_cameras(sketch, o, world, {truth}, {}, {}).views;
  }
  double worst = 0;
  for (int v = 0; v < kViews; ++v) worst = std::max(worst, apart_px(world.views[v], truth[v]));
  EXPECT_LT(worst, 0.3) << "a pixel by which ten edges of twenty-four wander";
}

TEST(Posed, StrokesThatAreRoundAreNoWitnessesOfCameras) {
  const std::vector<View> views = ring_of_views(kViews, kHouseMiddle, 3);
  Posed posed{make_edge_world(views, house_edgels(views)), strokes_of(house())};
  posed.round.assign(posed.sketch.size(), 0);
  const Observation all = look(posed, 2);
  posed.round[3] = 1;
  const Observation o = look(posed, 2);
  ASSERT_EQ(o.matches.first.size(), all.matches.first.size());
  int left_out = 0;
  for (int i = 0; i < o.layout.size(); ++i) {
    const int expected = o.layout.stroke[i] == 3 ? 0 : all.matches.views_of(i);
    EXPECT_EQ(o.matches.views_of(i), expected);
    left_out += all.matches.views_of(i) - o.matches.views_of(i);
  }
  EXPECT_GT(left_out, 0);
  for (const SampleMatch& m : o.matches.matches) EXPECT_NE(o.layout.stroke[m.sample], 3);
}

}  // namespace
}  // namespace sketchsplat
