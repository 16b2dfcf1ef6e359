// SPDX-License-Identifier: MIT
#include "topology/passes/simplify.h"

#include "tests/topology/build_sketch.h"

namespace sketchsplat {
namespace {

TEST(Simplify, AFragmentedBoxBecomesTwelveEdgesAndEightCorners) {
  // Every edge in two pieces with a gap of 4 px, ends 1 px short of the corners.
  Sketch s;
  for (int axis = 0; axis < 3; ++axis)
    for (int u : {0, 80})
      for (int v : {0, 60}) {
        const auto at = [&](double x) {
          Vector3d p;
          p[axis] = x;
          p[(axis + 1) % 3] = u;
          p[(axis + 2) % 3] = v;
          return p;
        };
        const double length = axis == 0 ? 100 : axis == 1 ? 100 : 100;
        add_line(&s, at(1), at(length / 2 - 2));
        add_line(&s, at(length - 1), at(length / 2 + 2));
      }
  // A box of 100 x 100 x 100 needs its edges at 0 and 100.
  for (int n = 0; n < s.nodes.cols(); ++n)
    for (int k = 0; k < 3; ++k)
      if (s.nodes(k, n) == 80 || s.nodes(k, n) == 60) s.nodes(k, n) = 100;
  const Simplified r = simplify(s, one_pixel());
  EXPECT_TRUE(r.settled);
  EXPECT_THAT(validate(r.sketch), testing::IsEmpty());
  EXPECT_EQ(r.sketch.size(), 12);
  EXPECT_THAT(node_degrees(r.sketch), testing::AllOf(testing::SizeIs(8), testing::Each(3)));
  for (int n = 0; n < r.sketch.nodes.cols(); ++n)
    for (int k = 0; k < 3; ++k) {
      const double x = r.sketch.nodes(k, n);
      EXPECT_LT(std::min(std::abs(x), std::abs(x - 100)), 0.3);
    }
  EXPECT_EQ(r.counts.collinear, 12);
  EXPECT_GT(r.counts.endpoints, 0);
}

TEST(Simplify, AHoleInFiveArcsBecomesACircle) {
  Sketch s;
  for (int k = 0; k < 5; ++k) add_arc(&s, {0, 0, 0}, 30, 72 * k + 4, 72 * k + 68);
  const Simplified r = simplify(s, one_pixel());
  ASSERT_EQ(r.sketch.size(), 1);
  EXPECT_EQ(r.sketch.strokes[0].kind, StrokeKind::kCircle);
  EXPECT_THAT(r.remap.stroke, testing::Each(0));
}

TEST(Simplify, ASlotStaysTwoLinesAndTwoArcs) {
  Sketch s;
  add_line(&s, {0, -10, 0}, {59.5, -10, 0});
  add_arc(&s, {60, 0, 0}, 10, -88, 90);
  add_line(&s, {59.7, 10, 0}, {0, 10, 0});
  add_arc(&s, {0, 0, 0}, 10, 92, 268);
  const Simplified r = simplify(s, one_pixel());
  EXPECT_EQ(r.sketch.size(), 4);
  EXPECT_THAT(node_degrees(r.sketch), testing::ElementsAre(2, 2, 2, 2));
}

TEST(Simplify, CountsAreNamed) {
  Sketch s;
  add_line(&s, {0, 0, 0}, {10, 0, 0});
  add_line(&s, {11, 0, 0}, {20, 0, 0});
  const Simplified r = simplify(s, one_pixel());
  EXPECT_EQ(r.counts.total(), 1);
  EXPECT_EQ(r.counts.rounds, 2);
  EXPECT_THAT(r.counts.named(), testing::Contains(testing::Pair("collinear", 1)));
  int sum = 0;
  for (const auto& [name, count] : r.counts.named()) sum += count;
  EXPECT_EQ(sum, r.counts.total());
}

TEST(Simplify, NothingAndOneStrokeStayAsTheyAre) {
  EXPECT_EQ(simplify(Sketch{}, one_pixel()).sketch.size(), 0);
  Sketch s;
  add_line(&s, {0, 0, 0}, {10, 0, 0});
  const Simplified r = simplify(s, one_pixel());
  EXPECT_EQ(r.counts.total(), 0);
  EXPECT_EQ(r.sketch.nodes, s.nodes);
}

TEST(Simplify, StrokesWithoutExtentOrWithNanGo) {
  Sketch s;
  add_line(&s, {1, 1, 1}, {1, 1, 1});
  add_line(&s, {0, 0, 0}, {std::nan(""), 0, 0});
  add_bezier(&s, {5, 5, 5}, {5, 5, 5}, {5, 5, 5}, {5, 5, 5});
  s.add_stroke(StrokeKind::kCircle, -1, -1, {Vector3d(0, 0, 0), Vector3d(0, 0, 0)});
  s.add_stroke(StrokeKind::kEllipse, -1, -1,
               {Vector3d(0, 0, 0), Vector3d(0, 0, 0), Vector3d(0, 0, 0)});
  add_arc(&s, {0, 0, 0}, 0, 0, 90);
  add_line(&s, {0, 0, 0}, {50, 0, 0});
  for (const auto pass : {merge_endpoints, merge_collinear}) {
    const PassResult r = pass(s, one_pixel(), {});
    expect_sound(r, s);
    EXPECT_EQ(r.sketch.size(), 1);
    EXPECT_EQ(r.changes, 6);
    EXPECT_EQ(r.remap.stroke.back(), 0);
  }
}

TEST(Simplify, WithoutAFootprintOnlyWhatCoincidesIsMerged) {
  Sketch s;
  add_line(&s, {0, 0, 0}, {50, 0, 0});
  add_line(&s, {50, 0, 0}, {50, 40, 0});
  add_line(&s, {50, 40.001, 0}, {0, 0.001, 0});
  const PassResult r = merge_endpoints(s, TopologyOptions{});
  expect_sound(r, s);
  EXPECT_EQ(r.changes, 1);
  EXPECT_EQ(r.sketch.nodes.cols(), 5);
}

}  // namespace
}  // namespace sketchsplat
