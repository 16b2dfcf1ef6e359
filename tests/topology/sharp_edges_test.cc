// SPDX-License-Identifier: MIT
// What a solid says of the strokes that it was found by.
#include "topology/solid/sharp_edges.h"

#include <algorithm>

#include "gmock/gmock.h"
#include "sketches/curve/curve.h"
#include "tests/topology/solids.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;
using ::testing::Each;
using ::testing::IsEmpty;

Sketch box() { return box_solid({0, 0, 0}, {3, 2, 1}).edges; }

TEST(SharpEdges, AnEdgeThatNoImageShowsIsAddedIfAskedFor) {
  for (int s = 0; s < 12; ++s) {
    const SolidSearch found = find_solid(without(box(), {s}));
    ASSERT_TRUE(found.solid) << found.why;
    const SharpEdges all = sharp_edges(found, true), seen = sharp_edges(found, false);
    EXPECT_EQ(all.sketch.size(), 12);
    EXPECT_EQ(std::count(all.inferred.begin(), all.inferred.end(), true), 1);
    EXPECT_THAT(validate(all.sketch), IsEmpty());
    EXPECT_EQ(seen.sketch.size(), 11);
    EXPECT_THAT(seen.inferred, Each(false));
  }
}

TEST(SharpEdges, WhereARoundMeetsAFlatThereIsAnEdgeUnlessItRunsSmoothlyIntoIt) {
  for (const double apex : {2.0, 1.3}) {
    const SolidSearch found = find_solid(tongue_edges(apex));
    ASSERT_TRUE(found.solid) << found.why;
    EXPECT_EQ(found.solid->edges.size(), 12);
    EXPECT_EQ(sharp_edges(found, true).sketch.size(), apex == 2 ? 10 : 12);
  }
}

TEST(SharpEdges, StrokesAreFoundAgain) {
  // The same edge twice, a little beside.
  Sketch twice = box();
  const Stroke first = twice.strokes[0];
  const Vector3d aside = 4e-3 * Vector3d(1, 1, 1);
  const int a = twice.add_node(twice.nodes.col(first.begin) + aside),
            b = twice.add_node(twice.nodes.col(first.end) + aside);
  twice.add_stroke(StrokeKind::kLine, a, b, {});
  const SolidSearch found = find_solid(twice);
  ASSERT_TRUE(found.solid) << found.why;
  EXPECT_EQ(found.twice, 1);
  const SharpEdges edges = sharp_edges(found, true);
  EXPECT_EQ(edges.sketch.size(), 12);
  ASSERT_EQ(edges.now.size(), 13u);
  EXPECT_TRUE(edges.now[0] == -1 || edges.now[12] == -1) << "one of the two is the edge";
  for (int s = 1; s < 12; ++s) {
    ASSERT_GE(edges.now[s], 0);
    const ControlPoints was = control_points(twice, s),
                        is = control_points(edges.sketch, edges.now[s]);
    EXPECT_LT((was.p[0] - is.p[0]).norm() + (was.p[1] - is.p[1]).norm(), 0.02);
  }
}

// A box of 4 x 3 x 2 with a square in its top of which nothing tells how deep it goes.
Sketch box_with_rim() {
  SolidMaker m;
  m.frame(2, 1.5, 0, 2);
  m.rectangle(0.5, 0.5, {0, 0, 2});
  return m.solid.edges;
}

TEST(SharpEdges, BetweenFacesThatAreSureTheyAreAddedWithoutASolid) {
  for (int s = 0; s < 12; ++s) {
    const Sketch seen = without(box_with_rim(), {s});
    const SolidSearch found = find_solid(seen);
    EXPECT_FALSE(found.solid);
    ASSERT_TRUE(found.shell) << found.why;
    const ControlPoints was = control_points(box_with_rim(), s);
    const SharpEdges all = with_sure_edges(seen, found, 0.01);
    ASSERT_EQ(all.sketch.size(), 16);
    EXPECT_THAT(validate(all.sketch), IsEmpty());
    EXPECT_TRUE(all.inferred.back());
    const ControlPoints is = control_points(all.sketch, 15);
    EXPECT_LT(std::min((was.p[0] - is.p[0]).norm(), (was.p[0] - is.p[1]).norm()), 1e-9);
    EXPECT_EQ(all.sketch.nodes.cols(), seen.nodes.cols()) << "its ends are nodes of others";
  }
}

// Rims of a square hole at both ends of a box, and that of a pocket that is deep beyond sight: the
// hole's four edges are inferred, of the pocket nothing is.
TEST(SharpEdges, OfAHoleBesideAPocketNobodySeesIntoAreAdded) {
  SolidMaker m;
  m.frame(3, 1.5, 0, 2);
  for (const Vector3d& rim : {Vector3d(-1.5, 0, 2), Vector3d(-1.5, 0, 0), Vector3d(1.5, 0, 2)})
    m.rectangle(0.5, 0.5, rim);
  const SolidSearch found = find_solid(m.solid.edges);
  EXPECT_FALSE(found.solid);
  ASSERT_TRUE(found.shell) << found.why;
  EXPECT_EQ(found.shell->faces.size(), 10u) << "six of the box, four of the hole";
  const SharpEdges all = with_sure_edges(m.solid.edges, found, 0.01);
  ASSERT_EQ(all.sketch.size(), 28);
  for (int s = 24; s < 28; ++s) {
    const ControlPoints line = control_points(all.sketch, s);
    EXPECT_NEAR((line.p[0] - line.p[1]).norm(), 2, 1e-9);
    EXPECT_NEAR(std::abs(line.p[0].x() + 1.5), 0.5, 1e-9);
  }
}

}  // namespace
}  // namespace sketchsplat
