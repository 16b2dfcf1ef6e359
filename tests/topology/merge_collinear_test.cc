// SPDX-License-Identifier: MIT
#include "tests/topology/build_sketch.h"
#include "topology/core/description.h"

namespace sketchsplat {
namespace {

TEST(MergeCollinear, TwoLinesOverAGapBecomeTheLineThroughBoth) {
  Sketch s;
  add_line(&s, {0, 0.2, 0}, {50, 0.2, 0});
  add_line(&s, {105, -0.2, 0}, {55, -0.2, 0});
  const PassResult r = merge_collinear(s, one_pixel());
  expect_sound(r, s);
  ASSERT_EQ(r.sketch.size(), 1);
  EXPECT_THAT(r.remap.stroke, testing::ElementsAre(0, 0));
  EXPECT_NEAR(stroke_length(r.sketch, 0), 105, 0.05);
  const ControlPoints c = control_points(r.sketch, 0);
  EXPECT_LT(distance_to_line({52.5, 0, 0}, c.p[0], c.p[1]), 1e-6);
}

TEST(MergeCollinear, AChainOfPiecesKeepsItsFullLength) {
  // Merging repeatedly into one line must never shorten it.
  Sketch s;
  for (int k : {3, 0, 4, 1, 2}) add_line(&s, {k * 25., 0, 0}, {k * 25. + 21, 0, 0});
  const PassResult r = merge_collinear(s, one_pixel());
  ASSERT_EQ(r.sketch.size(), 1);
  EXPECT_EQ(r.changes, 4);
  EXPECT_NEAR(stroke_length(r.sketch, 0), 121, 1e-9);
}

TEST(MergeCollinear, LinesThatOverlapInPartBecomeOne) {
  Sketch s;
  add_line(&s, {0, 0, 0}, {100, 0, 0});
  add_line(&s, {65, 0.5, 0}, {150, 0.5, 0});
  const PassResult r = merge_collinear(s, one_pixel());
  ASSERT_EQ(r.sketch.size(), 1);
  EXPECT_NEAR(stroke_length(r.sketch, 0), 150, 0.05);
}

TEST(MergeCollinear, AWideGapAnOffsetOrAnAngleKeepsLinesApart) {
  Sketch gap, offset, angle;
  add_line(&gap, {0, 0, 0}, {50, 0, 0});
  add_line(&gap, {57, 0, 0}, {100, 0, 0});
  add_line(&offset, {0, 0, 0}, {50, 0, 0});
  add_line(&offset, {52, 2, 0}, {100, 2, 0});
  add_line(&angle, {0, 0, 0}, {50, 0, 0});
  add_line(&angle, {50, 0, 0}, {99, 6, 0});
  for (const Sketch& s : {gap, offset, angle})
    EXPECT_EQ(merge_collinear(s, one_pixel()).changes, 0);
}

TEST(MergeCollinear, WhatTheImagesPutElsewhereStaysTwo) {
  // Drawn as one line; the images put the second piece aside, or at an angle.
  Sketch s;
  add_line(&s, {0, 0, 0}, {50, 0, 0});
  add_line(&s, {54, 0, 0}, {104, 0, 0});
  const StrokePoints drawn = drawn_points(s, one_pixel());
  EXPECT_EQ(merge_collinear(s, one_pixel(), drawn).changes, 1);
  StrokePoints seen = drawn;
  seen[1].row(1).array() += 1.5;
  EXPECT_EQ(merge_collinear(s, one_pixel(), seen).changes, 1) << "they are on neither";
  s.nodes(1, 2) = s.nodes(1, 3) = 1.2;
  EXPECT_EQ(merge_collinear(s, one_pixel(), seen).changes, 0);
}

TEST(MergeCollinear, TheUnionHasThePointsOfBoth) {
  Sketch s;
  add_line(&s, {0, 0, 0}, {50, 0, 0});
  add_line(&s, {54, 0, 0}, {104, 0, 0});
  add_line(&s, {0, 30, 0}, {0, 60, 0});
  const PassResult r = merge_collinear(s, one_pixel());
  ASSERT_EQ(r.points.size(), 2u);
  EXPECT_EQ(r.points[0].cols(), 50);
  EXPECT_EQ(r.points[1].cols(), 15);
}

TEST(MergeCollinear, ANodeThatOthersShareKeepsEdgesSplit) {
  Sketch s;
  add_line(&s, {0, 0, 0}, {50, 0, 0});
  s.add_stroke(StrokeKind::kLine, 1, s.add_node({100, 0, 0}), {});
  EXPECT_EQ(merge_collinear(s, one_pixel()).sketch.size(), 1);
  s.add_stroke(StrokeKind::kLine, 1, s.add_node({50, 70, 0}), {});
  EXPECT_EQ(merge_collinear(s, one_pixel()).changes, 0);
}

TEST(MergeCollinear, AnEndInTheGapKeepsEdgesSplit) {
  Sketch s;
  add_line(&s, {0, 0, 0}, {50, 0, 0});
  add_line(&s, {55, 0, 0}, {100, 0, 0});
  add_line(&s, {52, 1.5, 0}, {52, 70, 0});
  EXPECT_EQ(merge_collinear(s, one_pixel()).changes, 0);
}

TEST(MergeCollinear, AnEdgeThatOnlyPassesTheGapDoesNotMatter) {
  Sketch s;
  add_line(&s, {0, 0, 0}, {50, 0, 0});
  add_line(&s, {55, 0, 0}, {100, 0, 0});
  add_line(&s, {52, -70, 0}, {52, 70, 0});
  EXPECT_EQ(merge_collinear(s, one_pixel()).sketch.size(), 2);
}

TEST(MergeCollinear, ArcsOfOneCircleBecomeOneArc) {
  Sketch s;
  add_arc(&s, {0, 0, 0}, 40, 10, 80);
  add_arc(&s, {0, 0, 0}, 40, 150, 85);  // the other way round, gap 3.5 px
  const PassResult r = merge_collinear(s, one_pixel());
  expect_sound(r, s);
  ASSERT_EQ(r.sketch.size(), 1);
  ASSERT_EQ(r.sketch.strokes[0].kind, StrokeKind::kArc);
  EXPECT_NEAR(stroke_length(r.sketch, 0), 40 * 140 * M_PI / 180, 1e-6);
}

TEST(MergeCollinear, ArcsThatGoRoundBecomeACircle) {
  Sketch s;
  add_arc(&s, {0, 0, 0}, 40, 10, 80);
  add_arc(&s, {0, 0, 0}, 40, 85, 240);
  add_arc(&s, {0, 0, 0}, 40, 200, 366);
  const PassResult r = merge_collinear(s, one_pixel());
  expect_sound(r, s);
  ASSERT_EQ(r.sketch.size(), 1);
  ASSERT_EQ(r.sketch.strokes[0].kind, StrokeKind::kCircle);
  EXPECT_NEAR(control_points(r.sketch, 0).p[1].norm(), 40, 1e-6);
  EXPECT_EQ(r.sketch.nodes.cols(), 0);
}

TEST(MergeCollinear, ArcsOfDifferentCirclesStayTwo) {
  // An S: tangent to one another, bent the other way.
  Sketch s;
  add_arc(&s, {0, 0, 0}, 40, 0, 90);
  add_arc(&s, {0, 80, 0}, 40, 270, 180);
  EXPECT_EQ(merge_collinear(s, one_pixel()).changes, 0);
}

TEST(MergeCollinear, TheTwoHalvesOfACubicBecomeThatCubic) {
  // De Casteljau at 0.4 of (0,0) (30,60) (70,-60) (100,0).
  const std::vector<Vector3d> c = {{0, 0, 0}, {30, 60, 0}, {70, -60, 10}, {100, 0, 0}};
  const auto mix = [](const Vector3d& a, const Vector3d& b) { return Vector3d(0.6 * a + 0.4 * b); };
  const Vector3d a = mix(c[0], c[1]), b = mix(c[1], c[2]), d = mix(c[2], c[3]);
  const Vector3d e = mix(a, b), f = mix(b, d), g = mix(e, f);
  Sketch s;
  add_bezier(&s, c[0], a, e, g);
  s.add_stroke(StrokeKind::kBezier, s.add_node(c[3]), 1, {d, f});
  const PassResult r = merge_collinear(s, one_pixel());
  expect_sound(r, s);
  ASSERT_EQ(r.sketch.size(), 1);
  EXPECT_NEAR(stroke_length(r.sketch, 0), total_length(s), 0.2);
  const ControlPoints got = control_points(r.sketch, 0);
  const bool forward = got.p[0].x() < 50;
  for (int k = 0; k < 4; ++k) EXPECT_LT((got.p[forward ? k : 3 - k] - c[k]).norm(), 2) << k;
}

TEST(MergeCollinear, ACubicThatContinuesAnArcOnItsCircleBecomesPartOfTheArc) {
  Sketch s;
  add_arc(&s, {0, 0, 0}, 50, 0, 60);
  // Cubic of the same circle from 62 to 100 deg: handles 4/3 tan(theta / 4).
  const double k = 50 * 4 / 3. * std::tan(38 * M_PI / 180 / 4);
  const auto at = [](double deg) {
    return Vector3d(std::cos(deg * M_PI / 180), std::sin(deg * M_PI / 180), 0);
  };
  add_bezier(&s, 50 * at(62), 50 * at(62) + k * at(152), 50 * at(100) - k * at(190), 50 * at(100));
  const PassResult r = merge_collinear(s, one_pixel());
  ASSERT_EQ(r.sketch.size(), 1);
  ASSERT_EQ(r.sketch.strokes[0].kind, StrokeKind::kArc);
  EXPECT_NEAR(stroke_length(r.sketch, 0), 50 * 100 * M_PI / 180, 0.05);
}

TEST(MergeCollinear, CubicsThatOverlapInPartBecomeOne) {
  Sketch s;
  const auto piece = [&](double x0, double x1) {  // of the parabola y = x^2 / 100
    const auto at = [](double x) { return Vector3d(x, x * x / 100, 0); };
    const Vector3d h = (x1 - x0) / 3 * Vector3d(1, 0, 0);
    add_bezier(&s, at(x0), at(x0) + h + Vector3d(0, h.x() * x0 / 50, 0),
               at(x1) - h - Vector3d(0, h.x() * x1 / 50, 0), at(x1));
  };
  piece(-60, 20);
  piece(-10, 70);
  const PassResult r = merge_collinear(s, one_pixel());
  expect_sound(r, s);
  ASSERT_EQ(r.sketch.size(), 1);
  for (double t : {0.0, 0.3, 0.7, 1.0}) {
    Vector3d p, d;
    evaluate_stroke(r.sketch, 0, t, &p, &d);
    EXPECT_NEAR(p.y(), p.x() * p.x() / 100, 0.2);
  }
}

TEST(MergeCollinear, ALongLineStaysApartFromTheFilletItRunsInto) {
  Sketch s;
  add_line(&s, {-100, 0, 0}, {0, 0, 0});
  add_arc(&s, {0, 10, 0}, 10, -90, 0);
  EXPECT_EQ(merge_collinear(s, one_pixel()).changes, 0);
}

}  // namespace
}  // namespace sketchsplat
