// SPDX-License-Identifier: MIT
#include "pipelines/kinds.h"

#include <gtest/gtest.h>

#include "tests/support/strokes.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;
const Vector3d kMiddle(0.5, 0.5, 0.5);
const Vector3d kA(0.2, 0.3, 0.4), kB(0.8, 0.35, 0.6);

// What becomes of `stroke` (the only one of its sketch) where `truth` is seen.
Sketch chosen(const Sketch& stroke, const Sketch& truth) {
  const EdgeWorld w = ideal_world(ring_of_views(16, kMiddle, 3), polylines_of(truth));
  const PolishOptions polish_options;
  return choose_kinds(polish(stroke, w, polish_options), w, polish_options, {});
}

Sketch s_curve() {
  Sketch s;
  add_bezier(&s, {0.2, 0.3, 0.4}, {0.4, 0.7, 0.5}, {0.6, 0.0, 0.5}, {0.8, 0.4, 0.6});
  return s;
}

TEST(ChooseKinds, ACubicThatIsALineBecomesALine) {
  Sketch truth, cubic;
  add_line(&truth, kA, kB);
  const Vector3d off(0, 0.002, -0.002);
  add_bezier(&cubic, kA, kA + (kB - kA) / 3 + off, kB - (kB - kA) / 3 - off, kB);
  const Sketch s = chosen(cubic, truth);
  ASSERT_EQ(s.size(), 1);
  EXPECT_EQ(s.strokes[0].kind, StrokeKind::kLine);
  EXPECT_LT(farthest(s, 0, polylines_of(truth), 0.03), 0.1 * 3 / 500);
  EXPECT_LT((point_at(s, 0, 0) - kA).norm(), 0.02) << "its direction is kept";
  EXPECT_TRUE(validate(s).empty());
}

TEST(ChooseKinds, ACubicThatIsAnArcBecomesAnArc) {
  Sketch truth, cubic;
  const Vector3d c(0.3, 0.3, 0.5), u(0.4, 0, 0), v(0, 0.35, std::sqrt(0.16 - 0.35 * 0.35));
  add_arc(&truth, c + u, c + (u + v) / std::sqrt(2.), c + v);
  add_bezier(&cubic, c + u, c + u + 0.5523 * v, c + v + 0.5523 * u, c + v);
  const Sketch s = chosen(cubic, truth);
  ASSERT_EQ(s.size(), 1);
  EXPECT_EQ(s.strokes[0].kind, StrokeKind::kArc);
  EXPECT_LT(farthest(s, 0, polylines_of(truth), 0.03), 0.1 * 3 / 500);
}

TEST(ChooseKinds, AnArcThatIsALineBecomesALine) {
  Sketch truth, arc;
  add_line(&truth, kA, kB);
  add_arc(&arc, kA, (kA + kB) / 2 + Vector3d(0, 0.002, -0.002), kB);
  const Sketch s = chosen(arc, truth);
  ASSERT_EQ(s.size(), 1);
  EXPECT_EQ(s.strokes[0].kind, StrokeKind::kLine);
}

TEST(ChooseKinds, WhatIsReallyCurvedKeepsItsKind) {
  const Sketch s = chosen(s_curve(), s_curve());
  ASSERT_EQ(s.size(), 1);
  EXPECT_EQ(s.strokes[0].kind, StrokeKind::kBezier);
  EXPECT_LT(farthest(s, 0, polylines_of(s_curve()), 0.03), 0.1 * 3 / 500);

  Sketch arc;
  add_arc(&arc, kA, {0.5, 0.5, 0.55}, kB);
  EXPECT_EQ(chosen(arc, arc).strokes[0].kind, StrokeKind::kArc);
}

TEST(ChooseKinds, LinesCirclesAndTheOrderOfStrokesStay) {
  Sketch s;
  add_line(&s, {0.1, 0.1, 0.2}, {0.9, 0.1, 0.2});
  add_circle(&s, {0.5, 0.5, 0.8}, {0, 0, 0.2});
  const int cubic =
      add_bezier(&s, {0.2, 0.3, 0.4}, {0.4, 0.7, 0.5}, {0.6, 0.0, 0.5}, {0.8, 0.4, 0.6});
  s.evidence[cubic].support_views = 7;
  const Sketch out = chosen(s, s);
  ASSERT_EQ(out.size(), 3);
  EXPECT_EQ(out.strokes[0].kind, StrokeKind::kLine);
  EXPECT_EQ(out.strokes[1].kind, StrokeKind::kCircle);
  EXPECT_EQ(out.strokes[2].kind, StrokeKind::kBezier);
  EXPECT_EQ(out.evidence[2].support_views, 7);
  EXPECT_TRUE(validate(out).empty());
}

TEST(ChooseKinds, NothingAndWhatNobodySeesDoNoHarm) {
  EXPECT_EQ(chosen(Sketch(), s_curve()).size(), 0);
  Sketch far;
  add_bezier(&far, {40, 40, 40}, {41, 40, 41}, {42, 41, 41}, {43, 40, 40});
  add_arc(&far, {0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}, {0.5, 0.5, 0.5});
  const Sketch out = chosen(far, s_curve());
  EXPECT_EQ(out.size(), 2);
  EXPECT_TRUE(out.nodes.allFinite());
  EXPECT_TRUE(out.handles.size() == 0 || out.handles.allFinite());
}

}  // namespace
}  // namespace sketchsplat
