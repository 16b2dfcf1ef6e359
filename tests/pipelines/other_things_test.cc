// SPDX-License-Identifier: MIT
#include "pipelines/survey/other_things.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/strokes.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;
using testing::Each;

// Cameras around a table, the plane z = 0, that look at its middle from above.
EdgeWorld table_top() {
  const std::vector<View> views = ring_of_views(12, {0.5, 0.5, 0.2}, 3);
  std::vector<EdgelMap> maps;
  for (const View& view : views) maps.push_back(ideal_edgels(view, cube_edges({0.3, 0.3, 0}, 0.4)));
  EdgeWorld world = make_edge_world(views, maps);
  world.object.table = Eigen::Hyperplane<double, 3>(Vector3d::UnitZ(), 0);
  world.object.frame << 1, 0, 0, 0, 1, 0;
  world.object.box = {Vector3d(-0.5, -0.5, 0), Vector3d(1.5, 1.5, 0.8)};
  return world;
}

void add_cube(const Vector3d& low, double size, Sketch* s) {
  for (const Polyline& edge : cube_edges(low, size)) add_line(s, edge.front(), edge.back());
}

constexpr int kCube = 12;  // edges

TEST(OtherThings, AreWhatStandsApartFromTheObject) {
  Sketch s;
  add_cube({0.3, 0.3, 0}, 0.4, &s);
  add_cube({0.9, 0.5, 0}, 0.08, &s);
  const std::vector<char> things = of_other_things(s, table_top());
  for (int i = 0; i < s.size(); ++i) EXPECT_EQ(bool(things[i]), i >= kCube) << i;
}

TEST(OtherThings, AreNotKnownWithoutATable) {
  EdgeWorld world = table_top();
  world.object.table.reset();
  Sketch s;
  add_cube({0.3, 0.3, 0}, 0.4, &s);
  add_cube({0.9, 0.5, 0}, 0.08, &s);
  EXPECT_THAT(of_other_things(s, world), Each(0));
  EXPECT_TRUE(of_other_things({}, table_top()).empty());
}

TEST(OtherThings, AreNotWhatHangsOverTheObjectOrIsCutIntoIt) {
  Sketch s;
  add_cube({0.3, 0.3, 0}, 0.4, &s);
  add_circle(&s, {0.5, 0.5, 0.4}, {0, 0, 0.05});     // a hole in its lid
  add_circle(&s, {0.5, 0.3, 0.2}, {0, 0.05, 0});     // one in its side
  add_line(&s, {0.45, 0.5, 0.7}, {0.55, 0.5, 0.7});  // above all that
  EXPECT_THAT(of_other_things(s, table_top()), Each(0));
}

TEST(OtherThings, AreNotPiecesOfAnObjectThatFellApart) {
  Sketch s;
  for (const double x : {0.2, 0.5, 0.8})
    add_line(&s, {x, 0.2, 0.1}, {x, 0.8, 0.1}), add_line(&s, {x, 0.2, 0.3}, {x, 0.8, 0.3});
  EXPECT_THAT(of_other_things(s, table_top()), Each(0));
}

TEST(OtherThings, AreNotPiecesAtTheObjectsBorder) {
  const EdgeWorld world = table_top();
  for (const double px : {12, 40}) {
    Sketch s;
    add_cube({0.3, 0.3, 0}, 0.4, &s);
    const double x = 0.7 + px * world.footprint;
    add_line(&s, {x, 0.4, 0.2}, {x, 0.5, 0.2});
    EXPECT_EQ(bool(of_other_things(s, world)[kCube]), px > 20) << px;
  }
}

TEST(OtherThings, AreNotToldWhereTheObjectIsTheLesserPart) {
  Sketch s;
  add_cube({0.45, 0.45, 0}, 0.1, &s);
  for (int k = 0; k < 15; ++k)  // none of a quarter of its length
    add_line(&s, {-0.9 + 0.2 * k, 1.4, 0.1}, {-0.9 + 0.2 * k, 1.4, 0.35});
  EXPECT_THAT(of_other_things(s, table_top()), Each(0));
}

// A thing that looks like more than the object is not taken for it.
TEST(OtherThings, AreFoundAboutTheObjectThatTheCamerasLookAt) {
  Sketch s;
  add_cube({0.35, 0.35, 0}, 0.3, &s);
  for (int k = 0; k < 10; ++k)  // print on a thing beside it
    add_line(&s, {1.2, 1.2 + 0.03 * k, 0}, {1.4, 1.2 + 0.03 * k, 0});
  const std::vector<char> things = of_other_things(s, table_top());
  for (int i = 0; i < s.size(); ++i) EXPECT_FALSE(i < kCube && things[i]) << i;
}

}  // namespace
}  // namespace sketchsplat
