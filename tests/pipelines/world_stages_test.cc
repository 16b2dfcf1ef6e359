// SPDX-License-Identifier: MIT
// The stages from images to points, in a world of perfect edgels; how an object is told from other
// things is tested where it is found (object_region_test).
#include <gtest/gtest.h>

#include "datasets/types/errors.h"
#include "pipelines/method/detect_object.h"
#include "pipelines/method/finish.h"
#include "pipelines/method/lift_and_fit.h"
#include "pipelines/options/options.h"
#include "tests/support/strokes.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;
const Vector3d kMiddle(0.5, 0.5, 0.5);

// Two cubes, one beside the other.
EdgeWorld world_of(bool masks) {
  std::vector<Polyline> curves = cube_edges({0.1, 0.35, 0.35}, 0.3);
  for (const Polyline& p : cube_edges({0.6, 0.35, 0.35}, 0.3)) curves.push_back(p);
  const std::vector<View> views = ring_of_views(12, kMiddle, 3);
  std::vector<EdgelMap> maps;
  for (const View& view : views) {
    maps.push_back(ideal_edgels(view, curves));
    if (masks) maps.back().mask = Image<uint8_t>(view.camera.width, view.camera.height, 1);
  }
  return make_edge_world(views, maps);
}

size_t edgels_of(const EdgeWorld& world) {
  size_t sum = 0;
  for (const EdgelMap& map : world.maps) sum += map.edgels.size();
  return sum;
}

TEST(WorldStages, AWorldWithMasksIsLeftAsItIs) {
  const EdgeWorld world = world_of(true);
  const ReconstructOptions options;
  RunReport report;
  const EdgeWorld near = focus_on_object(world, {options, {&report}});
  EXPECT_EQ(edgels_of(near), edgels_of(world));
  EXPECT_TRUE(near.bounds.isApprox(world.bounds));
  EXPECT_TRUE(report.stages.empty()) << "nothing was looked for";
}

TEST(WorldStages, ABoxOfTheUserHoldsAllThatIsLifted) {
  const EdgeWorld world = world_of(false);
  ReconstructOptions options;
  options.box = Eigen::AlignedBox3d(Vector3d(0.05, 0.3, 0.3), Vector3d(0.45, 0.7, 0.7));
  RunReport report;
  const EdgeWorld near = focus_on_object(world, {options, {&report}});
  EXPECT_LT(edgels_of(near), edgels_of(world));
  const std::vector<EdgePoint> points = lift_scene(near, {options, {&report}});
  EXPECT_GT(points.size(), 200u);
  for (const EdgePoint& p : points) EXPECT_TRUE(options.box.contains(p.position));
  ASSERT_FALSE(report.counts.empty());
  EXPECT_EQ(report.counts.back().second, double(points.size()));
}

// Curves, and how meaningful they are.
struct Judged {
  std::vector<Polyline> curves;
  float meaning;
};

void add_square(double height, double half, Judged* to) {
  const Vector3d a(0.5 - half, 0.5 - half, height), x(2 * half, 0, 0), y(0, 2 * half, 0);
  for (const Polyline& side : {Polyline{a, a + x}, Polyline{a + x, a + x + y},
                               Polyline{a + x + y, a + y}, Polyline{a + y, a}})
    to->curves.push_back(side);
}

// Looked at from above.
EdgeWorld on_a_table(const std::vector<Judged>& things) {
  std::vector<View> views;
  for (const View& v : ring_of_views(50, {0.5, 0.5, 0.1}, 3))
    if (v.center_in_world().z() > 1.5) views.push_back(v);
  std::vector<EdgelMap> maps;
  for (const View& view : views) {
    EdgelMap all;
    all.chain.push_back(0);
    for (const Judged& thing : things) {
      EdgelMap one = ideal_edgels(view, thing.curves);
      one.meaning.assign(one.num_chains(), thing.meaning);
      all.width = one.width, all.height = one.height;
      append_runs(one, std::vector<char>(one.edgels.size(), 1), 1, &all);
    }
    maps.push_back(all);
  }
  return make_edge_world(views, maps);
}

// In a first look clear print on the table hides all of the part but its hub.
TEST(WorldStages, ASecondLookTellsHowFarAnObjectReaches) {
  Judged hub{{}, 9}, print{{}, 5}, steps{{}, 1};
  add_square(0.3, 0.08, &hub);
  add_square(0.2, 0.08, &hub);
  for (double x = -0.9; x < 2; x += 0.1)
    if (std::abs(x - 0.5) > 0.8) print.curves.push_back({{x, -0.4, 0}, {x, 1.4, 0}});
  for (const double half : {0.18, 0.27, 0.36}) add_square(0.2, half, &steps);
  RunReport report;
  const EdgeWorld near =
      focus_on_object(on_a_table({hub, print, steps}), {ReconstructOptions(), {&report}});
  ASSERT_TRUE(near.object.table);
  for (const double x : {0.14, 0.86})
    for (const double y : {0.14, 0.86}) EXPECT_TRUE(near.object.contains({x, y, 0.2})) << x << y;
  EXPECT_FALSE(near.object.contains({1.3, 0.5, 0.2}));
}

// What other views show beside a corner that few see pulls at it.
TEST(WorldStages, CornersInPocketsDoNotMoveFarFromWhereTheRimHasThem) {
  const EdgeWorld world = world_of(true);
  const Vector3d corner(0.1, 0.35, 0.35), stated = corner + Vector3d(0, 0, 2.2 * world.footprint);
  Sketch sketch;
  const int a = sketch.add_node(stated), b = sketch.add_node({0.4, 0.35, 0.35});
  sketch.add_stroke(StrokeKind::kLine, a, b, {});
  ReconstructOptions options;
  RunReport report;
  const MethodRun run{options, {&report}};
  const Sketch free = polish_and_regularize({sketch, {}, {}}, world, run).sketch;
  EXPECT_NEAR(free.nodes(2, 0), corner.z(), 0.3 * world.footprint) << "it may slide along";
  const Sketch held = polish_and_regularize({sketch, {stated}, {}}, world, run).sketch;
  EXPECT_LT((held.nodes.col(0) - stated).norm(), 1e-12);
  EXPECT_LT((held.nodes.col(1) - free.nodes.col(1)).norm(), 1e-12) << "others are free";
}

TEST(WorldStages, WhereNoViewsAgreeThereIsTooLittle) {
  EdgeWorld world = world_of(false);
  for (EdgelMap& map : world.maps) map = ideal_edgels(world.views[0], {});
  RunReport report;
  EXPECT_THROW(lift_scene(world, {ReconstructOptions(), {&report}}), TooLittleError);
}

}  // namespace
}  // namespace sketchsplat
