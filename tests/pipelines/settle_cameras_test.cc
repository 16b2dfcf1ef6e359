// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "pipelines/cameras/bring_back.h"
#include "pipelines/cameras/posed.h"
#include "tests/support/strokes.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;
const Vector3d kMiddle(0.5, 0.5, 0.5);
constexpr int kViews = 16;

// A block and a bar in it: what it shows fixes a camera.
std::vector<Polyline> edges() {
  std::vector<Polyline> out = cube_edges({0.2, 0.2, 0.2}, 0.6);
  for (const Polyline& p : cube_edges({0.35, 0.42, 0.3}, 0.25)) out.push_back(p);
  return out;
}

Sketch strokes_of(const std::vector<Polyline>& lines) {
  Sketch sketch;
  for (const Polyline& p : lines) add_line(&sketch, p[0], p[1]);
  return sketch;
}

std::vector<EdgelMap> pictures(const std::vector<View>& views) {
  std::vector<EdgelMap> maps;
  for (const View& v : views) maps.push_back(ideal_edgels(v, edges()));
  return maps;
}

// Shifted so that the object moves by so many pixels.
View shifted(View v, double dx, double dy) {
  const double depth = (v.cam_from_world * kMiddle).z();
  v.cam_from_world.translation += Vector3d(dx * depth / v.camera.fx, dy * depth / v.camera.fy, 0);
  return v;
}

// Largest distance [px] of corners of the object in one camera and in another.
double apart_px(const View& a, const View& b) {
  double worst = 0, depth;
  for (const Polyline& p : edges())
    worst = std::max(worst, (a.project(p[0], &depth) - b.project(p[0], &depth)).norm());
  return worst;
}

TEST(BringBack, AViewThatIsSixPixelsOffComesBackAndTheOthersStay) {
  const std::vector<View> truth = ring_of_views(kViews, kMiddle, 3);
  std::vector<View> stated = truth;
  stated[5] = shifted(truth[5], 5, -3.5);
  EdgeWorld world = make_edge_world(stated, pictures(truth));
  EXPECT_EQ(bring_back(strokes_of(edges()), {stated}, {}, &world), 1);
  EXPECT_LT(apart_px(world.views[5], truth[5]), 0.1);
  for (int v = 0; v < kViews; ++v)
    EXPECT_EQ(apart_px(world.views[v], v == 5 ? world.views[5] : stated[v]), 0) << v;
}

TEST(BringBack, NothingMovesWhereAllViewsFitOrNothingIsDrawn) {
  const std::vector<View> truth = ring_of_views(kViews, kMiddle, 3);
  EdgeWorld world = make_edge_world(truth, pictures(truth));
  EXPECT_EQ(bring_back(strokes_of(edges()), {truth}, {}, &world), 0);
  EXPECT_EQ(bring_back({}, {truth}, {}, &world), 0);
}

TEST(FitCameras, StrokesThatWanderFromViewToViewHardlyBendTheCameras) {
  const std::vector<View> truth = ring_of_views(kViews, kMiddle, 3);
  std::vector<EdgelMap> maps = pictures(truth);
  constexpr int kWandering = 10;  // edges, all to one side in a view, as outlines of rounds do
  for (int v = 0; v < kViews; ++v) {
    EdgelMap& map = maps[v];
    const Eigen::Vector2d by(std::cos(2.4 * v), std::sin(2.4 * v));
    for (int i = 0; i < map.chain[kWandering]; ++i)
      map.edgels[i].x += float(by.x()), map.edgels[i].y += float(by.y());
    build_lookup(&map, 4.0);
  }
  const Sketch sketch = strokes_of(edges());
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
  const std::vector<View> views = ring_of_views(kViews, kMiddle, 3);
  Posed posed{make_edge_world(views, pictures(views)), strokes_of(edges())};
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
