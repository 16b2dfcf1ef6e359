// SPDX-License-Identifier: MIT
#include "tests/topology/build_sketch.h"

namespace sketchsplat {
namespace {

TEST(MergeOverlaps, ALineDrawnTwiceBecomesItsWeightedMeanOverTheUnion) {
  Sketch s;
  add_line(&s, {0, 0, 0}, {100, 0, 0}, with_opacity(0.9));
  add_line(&s, {110, 1.2, 0}, {20, 1.2, 0}, with_opacity(0.1));
  const PassResult r = merge_overlaps(s, one_pixel());
  expect_sound(r, s);
  ASSERT_EQ(r.sketch.size(), 1);
  EXPECT_THAT(r.remap.stroke, testing::ElementsAre(0, 0));
  EXPECT_EQ(r.changes, 1);
  const ControlPoints c = control_points(r.sketch, 0);
  EXPECT_NEAR(stroke_length(r.sketch, 0), 110, 0.1);
  // 90 : 9 for the first: near 0.11, neither the one nor the plain mean.
  EXPECT_NEAR((c.p[0].y() + c.p[1].y()) / 2, 0.11, 0.06);
  EXPECT_NEAR(r.sketch.evidence[0].opacity, (0.9 * 100 + 0.1 * 90) / 190, 1e-9);
}

TEST(MergeOverlaps, TheBetterSupportedStrokeDecidesWhateverItsIndex) {
  for (bool swap : {false, true}) {
    Sketch s;
    const auto good = [&] { add_line(&s, {0, 0, 0}, {100, 0, 0}, with_opacity(1)); };
    const auto bad = [&] { add_line(&s, {0, 1.5, 0}, {95, 1.5, 0}, with_opacity(0.01)); };
    if (swap) {
      bad();
      good();
    } else {
      good();
      bad();
    }
    const PassResult r = merge_overlaps(s, one_pixel());
    ASSERT_EQ(r.sketch.size(), 1);
    EXPECT_LT(std::abs(control_points(r.sketch, 0).p[0].y()), 0.03);
  }
}

TEST(MergeOverlaps, TwoParallelLinesFourPixelsApartStayTwo) {
  Sketch s;
  add_line(&s, {0, 0, 0}, {100, 0, 0});
  add_line(&s, {0, 4, 0}, {100, 4, 0});
  EXPECT_EQ(merge_overlaps(s, one_pixel()).changes, 0);
  EXPECT_EQ(merge_collinear(s, one_pixel()).changes, 0);
  EXPECT_EQ(merge_endpoints(s, one_pixel()).changes, 0);
}

TEST(MergeOverlaps, LinesThatCrossStayTwo) {
  Sketch s;
  add_line(&s, {0, 0, 0}, {100, 0, 0});
  add_line(&s, {49, -2, 0}, {51, 2, 0});  // all of it is near the other, but across
  EXPECT_EQ(merge_overlaps(s, one_pixel()).changes, 0);
}

TEST(MergeOverlaps, SeventyPercentAreTooLittle) {
  Sketch s;
  add_line(&s, {0, 0, 0}, {100, 0, 0});
  add_line(&s, {30, 1, 0}, {65, 1, 0});
  add_line(&s, {72.0, -40, 0}, {72.0, 40, 0});
  s.nodes.col(3) = Vector3d(65, 1, 0);
  Sketch partly;
  add_line(&partly, {0, 0, 0}, {100, 0, 0});
  add_line(&partly, {65, 1, 0}, {115, 1, 0});  // 35 of 50
  EXPECT_EQ(merge_overlaps(s, one_pixel()).changes, 1);
  EXPECT_EQ(merge_overlaps(partly, one_pixel()).changes, 0);
}

TEST(MergeOverlaps, ANodeSharedWithOthersStays) {
  Sketch s;
  add_line(&s, {0, 0, 0}, {100, 0, 0});
  s.add_stroke(StrokeKind::kLine, 0, s.add_node({0, 60, 0}), {});
  add_line(&s, {2, 1, 0}, {101, 1, 0});
  const PassResult r = merge_overlaps(s, one_pixel());
  expect_sound(r, s);
  ASSERT_EQ(r.sketch.size(), 2);
  EXPECT_THAT(r.remap.stroke, testing::ElementsAre(0, 1, 0));
  const Stroke &merged = r.sketch.strokes[0], &side = r.sketch.strokes[1];
  EXPECT_TRUE(merged.begin == side.begin || merged.end == side.begin);
  EXPECT_EQ(Vector3d(r.sketch.nodes.col(side.begin)), Vector3d(0, 0, 0));
}

TEST(MergeOverlaps, AnArcOnACircleJoinsTheCircle) {
  Sketch s;
  s.add_stroke(StrokeKind::kCircle, -1, -1, {Vector3d(0, 0, 0), Vector3d(0, 0, 30)});
  add_arc(&s, {0.5, 0, 0}, 31, 10, 140);
  const PassResult r = merge_overlaps(s, one_pixel());
  expect_sound(r, s);
  ASSERT_EQ(r.sketch.size(), 1);
  ASSERT_EQ(r.sketch.strokes[0].kind, StrokeKind::kCircle);
  const double radius = control_points(r.sketch, 0).p[1].norm();
  EXPECT_GT(radius, 30.1);
  EXPECT_LT(radius, 30.9);
}

TEST(MergeOverlaps, AnEllipseDrawnTwiceIsRefitted) {
  Sketch s;
  s.add_stroke(StrokeKind::kEllipse, -1, -1,
               {Vector3d(0, 0, 0), Vector3d(50, 0, 0), Vector3d(0, 30, 0)});
  s.add_stroke(StrokeKind::kEllipse, -1, -1,
               {Vector3d(0, 0, 1), Vector3d(0, -30, 0), Vector3d(50, 0, 0)});
  const PassResult r = merge_overlaps(s, one_pixel());
  ASSERT_EQ(r.sketch.size(), 1);
  const ControlPoints c = control_points(r.sketch, 0);
  EXPECT_LT((c.p[0] - Vector3d(0, 0, 0.5)).norm(), 1e-6);
  EXPECT_NEAR(c.p[1].norm(), 50, 1e-6);
  EXPECT_NEAR(c.p[2].norm(), 30, 1e-6);
}

TEST(MergeOverlaps, ACubicDrawnTwiceLiesBetweenBoth) {
  Sketch s;
  add_bezier(&s, {0, 0, 0}, {30, 60, 0}, {70, -60, 20}, {100, 0, 0});
  add_bezier(&s, {100, 0, 1}, {70, -60, 21}, {30, 60, 1}, {0, 0, 1});
  const PassResult r = merge_overlaps(s, one_pixel());
  expect_sound(r, s);
  ASSERT_EQ(r.sketch.size(), 1);
  Vector3d p, q, m, d;
  evaluate_stroke(s, 0, 0.5, &p, &d);
  evaluate_stroke(s, 1, 0.5, &q, &d);
  evaluate_stroke(r.sketch, 0, 0.5, &m, &d);
  EXPECT_LT((m - (p + q) / 2).norm(), 0.3);
}

TEST(MergeOverlaps, AHookIsNotSwallowed) {
  // Nine tenths lie on the line, the rest leaves it by 6 px: no one curve of either kind fits both.
  Sketch s;
  add_line(&s, {0, 0, 0}, {300, 0, 0});
  add_bezier(&s, {100, 0, 0}, {200, 0, 0}, {158, 0, 0}, {160, 7, 0});
  EXPECT_EQ(merge_overlaps(s, one_pixel()).sketch.size(), 2);
}

}  // namespace
}  // namespace sketchsplat
