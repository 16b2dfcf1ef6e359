// SPDX-License-Identifier: MIT
#include "tests/topology/build_sketch.h"
#include "topology/core/description.h"

namespace sketchsplat {
namespace {

// Places are known to a pixel and a half.
TopologyOptions blurred() {
  TopologyOptions options = one_pixel();
  options.sigma_px = 1.5;
  return options;
}

TEST(MergeEndpoints, EndsThatTheImagesKeepApartStayApart) {
  // Two lines whose ends pass one another at 1.5 px: sharp images tell them from a corner.
  Sketch s;
  add_line(&s, {-50, 0, 0}, {0, 0, 0});
  add_line(&s, {0, 0, 1.5}, {0, 50, 1.5});
  EXPECT_EQ(merge_endpoints(s, one_pixel()).changes, 0);
  EXPECT_EQ(merge_endpoints(s, blurred()).changes, 1);
  // So do images that put both lines into one plane, wherever they are drawn.
  StrokePoints seen = drawn_points(s, one_pixel());
  for (Eigen::Matrix3Xd& points : seen) points.row(2).setConstant(0.75);
  EXPECT_EQ(merge_endpoints(s, one_pixel(), seen).changes, 1);
}

TEST(MergeEndpoints, TheCornerLiesWhereTheLongStrokeSaysIt) {
  // A short stroke is known less well: it bends to the long one.
  Sketch s;
  add_line(&s, {-200, 0, 0}, {0, 0, 0});
  add_line(&s, {0, 1, 0.5}, {0, 8, 0.5});
  const PassResult r = merge_endpoints(s, one_pixel());
  ASSERT_EQ(r.changes, 1);
  EXPECT_LT(r.sketch.nodes.col(r.sketch.strokes[0].end).norm(), 0.05);
}

TEST(MergeEndpoints, TwoLinesMeetInTheirIntersection) {
  Sketch s;
  add_line(&s, {-100, 0, 0}, {-1, 0, 0});
  add_line(&s, {0, 1.5, 0}, {0, 80, 0});
  const PassResult r = merge_endpoints(s, one_pixel());
  expect_sound(r, s);
  EXPECT_EQ(r.changes, 1);
  ASSERT_EQ(r.sketch.strokes[0].end, r.sketch.strokes[1].begin);
  EXPECT_LT(r.sketch.nodes.col(r.sketch.strokes[0].end).norm(), 1e-9);
}

TEST(MergeEndpoints, ThreeLinesMeetInTheCorner) {
  Sketch s;
  add_line(&s, {101, 2, 3}, {2, 2, 3});
  add_line(&s, {1, 3, 3}, {1, 90, 3});
  add_line(&s, {1, 2, 50}, {1, 2, 4.2});
  const PassResult r = merge_endpoints(s, one_pixel());
  expect_sound(r, s);
  EXPECT_EQ(r.sketch.nodes.cols(), 4);
  const Stroke& first = r.sketch.strokes[0];
  EXPECT_EQ(first.end, r.sketch.strokes[1].begin);
  EXPECT_EQ(first.end, r.sketch.strokes[2].end);
  EXPECT_LT((r.sketch.nodes.col(first.end) - Vector3d(1, 2, 3)).norm(), 1e-9);
}

TEST(MergeEndpoints, ParallelEndsMeetInTheMean) {
  Sketch s;
  add_line(&s, {-50, 0, 0}, {0, 0, 0});
  add_line(&s, {2, 1, 0}, {52, 1, 0});
  const PassResult r = merge_endpoints(s, blurred());
  expect_sound(r, s);
  ASSERT_EQ(r.sketch.strokes[0].end, r.sketch.strokes[1].begin);
  EXPECT_LT((r.sketch.nodes.col(r.sketch.strokes[0].end) - Vector3d(1, 0.5, 0)).norm(), 1e-9);
}

TEST(MergeEndpoints, NoEndMovesFartherThanTheTolerance) {
  // The lines cross 11 px from the ends.
  Sketch s;
  add_line(&s, {-50, 0, 0}, {0, 0, 0});
  const double slope = std::tan(25 * M_PI / 180);
  add_line(&s, {-50, -61 * slope + 10, 0}, {0, 2.5, 0});
  const PassResult r = merge_endpoints(s, blurred());
  ASSERT_EQ(r.sketch.strokes[0].end, r.sketch.strokes[1].end);
  const Vector3d node = r.sketch.nodes.col(r.sketch.strokes[0].end);
  EXPECT_LE(node.norm(), 3 + 1e-9);
  EXPECT_LE((node - Vector3d(0, 2.5, 0)).norm(), 3 + 1e-9);
}

TEST(MergeEndpoints, AChainOfNearEndsDoesNotCollapse) {
  // Combs whose teeth end 0.8, 0.3 and 0.55 tolerances apart.
  for (double step : {2.4, 0.9, 1.65}) {
    Sketch s;
    for (int i = 0; i < 12; ++i) add_line(&s, {i * step, 0, 0}, {i * step, 100. + 7 * i, 0});
    const PassResult r = merge_endpoints(s, one_pixel());
    expect_sound(r, s);
    EXPECT_EQ(r.sketch.size(), 12);
    // Every tooth still begins near where it began.
    for (int i = 0; i < 12; ++i)
      EXPECT_LE((r.sketch.nodes.col(r.sketch.strokes[i].begin) - Vector3d(i * step, 0, 0)).norm(),
                3.0)
          << step;
    EXPECT_GE(r.sketch.nodes.cols() - 12, 11 * step / 6) << step;
  }
}

TEST(MergeEndpoints, EndsBeyondTheToleranceStayApart) {
  Sketch s;
  add_line(&s, {-50, 0, 0}, {0, 0, 0});
  add_line(&s, {0, 3.1, 0}, {0, 50, 0});
  EXPECT_EQ(merge_endpoints(s, one_pixel()).changes, 0);
}

TEST(MergeEndpoints, ABezierFollowsItsEndWithoutAKink) {
  Sketch s;
  const int b = add_bezier(&s, {0, 0, 0}, {30, 20, 0}, {60, 20, 0}, {90, 0, 0});
  add_line(&s, {-2, 0, 1}, {-60, -40, 1});
  const PassResult r = merge_endpoints(s, blurred());
  expect_sound(r, s);
  ASSERT_EQ(r.sketch.strokes[0].begin, r.sketch.strokes[1].begin);
  // Displaced no more at any point than at the end.
  Vector3d p, q, dp, dq;
  evaluate_stroke(r.sketch, b, 0, &p, &dp);
  const Vector3d move = p;
  EXPECT_GT(move.norm(), 0.5);
  for (double t : {0.0, 0.25, 0.5, 1.0}) {
    evaluate_stroke(s, b, t, &p, &dp);
    evaluate_stroke(r.sketch, b, t, &q, &dq);
    EXPECT_LE((q - p).norm(), move.norm() + 1e-9);
    EXPECT_LT(std::acos(dp.normalized().dot(dq.normalized())) * 180 / M_PI, 2.5);
  }
}

TEST(MergeEndpoints, AnArcThatIsExtendedStaysOnItsCircle) {
  Sketch s;
  const int a = add_arc(&s, {0, 0, 0}, 100, 0, 60);
  const double end = 61 * M_PI / 180;  // 1.7 px further on the same circle
  const Vector3d next(100 * std::cos(end), 100 * std::sin(end), 0);
  add_line(&s, next, next + Vector3d(0, 0, 50));
  add_line(&s, next, next + Vector3d(40, 70, 0));
  const PassResult r = merge_endpoints(s, one_pixel());
  ASSERT_EQ(r.sketch.strokes[0].end, r.sketch.strokes[1].begin);
  for (double t : {0.2, 0.5, 0.8}) {
    Vector3d p, d;
    evaluate_stroke(r.sketch, a, t, &p, &d);
    EXPECT_NEAR(p.norm(), 100, 0.02);
  }
}

TEST(MergeEndpoints, AShortStrokeIsRemovedAndItsEndsAreJoined) {
  Sketch s;
  add_line(&s, {-100, 0, 0}, {0, 0, 0});
  const int bevel = s.add_stroke(StrokeKind::kLine, 1, s.add_node({1.5, 1, 0}), {});
  s.add_stroke(StrokeKind::kLine, 2, s.add_node({1.5, 90, 0}), {});
  const PassResult r = merge_endpoints(s, one_pixel());
  expect_sound(r, s);
  EXPECT_EQ(r.remap.stroke[bevel], -1);
  EXPECT_EQ(r.sketch.size(), 2);
  EXPECT_EQ(r.sketch.nodes.cols(), 3);
  // The corner of the two long lines, not an end of the bevel.
  EXPECT_LT((r.sketch.nodes.col(r.sketch.strokes[0].end) - Vector3d(1.5, 0, 0)).norm(), 1e-9);
}

TEST(MergeEndpoints, ALoneShortStrokeIsRemoved) {
  Sketch s;
  add_line(&s, {0, 0, 0}, {2.9, 0, 0});
  const PassResult r = merge_endpoints(s, one_pixel());
  EXPECT_EQ(r.sketch.size(), 0);
  EXPECT_EQ(r.remap.stroke[0], -1);
}

TEST(MergeEndpoints, ATinyHoleOfFourArcsIsKept) {
  for (double gap_deg : {0.0, 12.0}) {
    Sketch s;
    for (int k = 0; k < 4; ++k) add_arc(&s, {5, 5, 0}, 1.2, 90 * k, 90 * (k + 1) - gap_deg);
    const PassResult r = merge_endpoints(s, one_pixel());
    expect_sound(r, s);
    EXPECT_EQ(r.sketch.size(), 4);
    EXPECT_THAT(node_degrees(r.sketch), testing::ElementsAre(2, 2, 2, 2));
    EXPECT_GT(total_length(r.sketch), 0.9 * total_length(s));
  }
}

TEST(MergeEndpoints, TwoHalvesOfATinyHoleAreKept) {
  Sketch s;
  add_arc(&s, {0, 0, 0}, 0.8, 0, 175);
  add_arc(&s, {0, 0, 0}, 0.8, 180, 355);
  const PassResult r = merge_endpoints(s, one_pixel());
  EXPECT_EQ(r.sketch.size(), 2);
  EXPECT_THAT(node_degrees(r.sketch), testing::ElementsAre(2, 2));
}

TEST(MergeEndpoints, AnArcWithASmallGapBecomesACircle) {
  Sketch s;
  add_arc(&s, {1, 2, 3}, 20, 0, 354);  // gap 2.1 px
  const PassResult r = merge_endpoints(s, one_pixel());
  expect_sound(r, s);
  ASSERT_EQ(r.sketch.strokes[0].kind, StrokeKind::kCircle);
  const ControlPoints c = control_points(r.sketch, 0);
  EXPECT_LT((c.p[0] - Vector3d(1, 2, 3)).norm(), 1e-9);
  EXPECT_NEAR(c.p[1].norm(), 20, 1e-9);
}

TEST(MergeEndpoints, AnOpenCubicWithASmallGapIsClosed) {
  Sketch s;
  add_bezier(&s, {0, 0, 0}, {60, 60, 0}, {-60, 60, 0}, {-2, 0, 0});
  const PassResult r = merge_endpoints(s, one_pixel());
  expect_sound(r, s);
  EXPECT_EQ(r.sketch.nodes.cols(), 1);
  EXPECT_NEAR(total_length(r.sketch), total_length(s), 4);
}

TEST(MergeEndpoints, AHairpinIsNotFolded) {
  // Chord 2.5, way round 5.2: neither a gap to close nor a stroke to remove.
  Sketch s;
  add_bezier(&s, {0, 0, 0}, {0, 3, 0}, {2.5, 3, 0}, {2.5, 0, 0});
  EXPECT_EQ(merge_endpoints(s, one_pixel()).changes, 0);
}

}  // namespace
}  // namespace sketchsplat
