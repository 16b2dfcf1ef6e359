// SPDX-License-Identifier: MIT
#include "pipelines/join/rechain.h"

#include <gtest/gtest.h>

#include "tests/support/strokes.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;
const Vector3d kMiddle(0.5, 0.5, 0.5);

EdgeWorld world_of(const Sketch& truth) {
  return ideal_world(ring_of_views(16, kMiddle, 3), polylines_of(truth));
}
Rechained again(const Sketch& s, const EdgeWorld& world) { return rechain(s, world, {}, {}); }
int count_of(const Sketch& s, StrokeKind kind) {
  int n = 0;
  for (const Stroke& stroke : s.strokes) n += stroke.kind == kind;
  return n;
}

// A rounded corner: two lines and the arc between them.
Sketch rounded_corner() {
  Sketch s;
  const double r = 0.15;
  const int a = s.add_node({0.2, 0.3, 0.5}), b = s.add_node({0.65, 0.3, 0.5});
  const int c = s.add_node({0.8, 0.45, 0.5}), d = s.add_node({0.8, 0.8, 0.5});
  s.add_stroke(StrokeKind::kLine, a, b, {});
  s.add_stroke(StrokeKind::kArc, b, c,
               {Vector3d(0.65 + r * std::sqrt(0.5), 0.45 - r * std::sqrt(0.5), 0.5)});
  s.add_stroke(StrokeKind::kLine, c, d, {});
  return s;
}

TEST(Rechain, CubicsOverARoundedCornerBecomeLineArcLine) {
  const Sketch truth = rounded_corner();
  const EdgeWorld world = world_of(truth);
  Sketch s;  // as two curves that meet in the middle of the arc
  const double r = 0.15;
  const Vector3d middle(0.65 + r * std::sqrt(0.5), 0.45 - r * std::sqrt(0.5), 0.5);
  const int a = s.add_node({0.2, 0.3, 0.5}), m = s.add_node(middle),
            d = s.add_node({0.8, 0.8, 0.5});
  const Vector3d way = Vector3d(1, 1, 0).normalized();
  s.add_stroke(StrokeKind::kBezier, a, m, {Vector3d(0.5, 0.3, 0.5), middle - 0.05 * way});
  s.add_stroke(StrokeKind::kBezier, m, d, {middle + 0.05 * way, Vector3d(0.8, 0.55, 0.5)});
  const Rechained out = again(s, world);
  EXPECT_EQ(out.changes, 1);
  ASSERT_EQ(out.sketch.size(), 3);
  EXPECT_EQ(count_of(out.sketch, StrokeKind::kLine), 2);
  EXPECT_EQ(count_of(out.sketch, StrokeKind::kArc), 1);
  EXPECT_EQ(out.sketch.nodes.cols(), 4);
  EXPECT_TRUE(validate(out.sketch).empty());
}

TEST(Rechain, ALineInThreePiecesIsOneLine) {
  Sketch truth;
  add_line(&truth, {0.2, 0.3, 0.5}, {0.8, 0.4, 0.5});
  Sketch s;
  const Vector3d p(0.2, 0.3, 0.5), v(0.6, 0.1, 0);
  const int a = s.add_node(p), b = s.add_node(p + 0.4 * v), c = s.add_node(p + 0.7 * v),
            d = s.add_node(p + v);
  s.add_stroke(StrokeKind::kLine, a, b, {});
  s.add_stroke(StrokeKind::kLine, b, c, {});
  s.add_stroke(StrokeKind::kLine, d, c, {});  // backwards
  const Rechained out = again(s, world_of(truth));
  ASSERT_EQ(out.sketch.size(), 1);
  EXPECT_EQ(out.sketch.strokes[0].kind, StrokeKind::kLine);
  EXPECT_NEAR(stroke_length(out.sketch, 0), v.norm(), 1e-6);
}

TEST(Rechain, WhereAThirdStrokeMeetsAChainEnds) {
  Sketch truth;
  add_line(&truth, {0.2, 0.3, 0.5}, {0.8, 0.3, 0.5});
  add_line(&truth, {0.5, 0.3, 0.5}, {0.5, 0.7, 0.5});
  Sketch s;
  const int a = s.add_node({0.2, 0.3, 0.5}), b = s.add_node({0.5, 0.3, 0.5}),
            c = s.add_node({0.8, 0.3, 0.5}), d = s.add_node({0.5, 0.7, 0.5});
  s.add_stroke(StrokeKind::kLine, a, b, {});
  s.add_stroke(StrokeKind::kLine, b, c, {});
  s.add_stroke(StrokeKind::kLine, b, d, {});
  const Rechained out = again(s, world_of(truth));
  EXPECT_EQ(out.changes, 0);
  EXPECT_EQ(out.sketch.size(), 3);
  EXPECT_EQ(out.sketch.nodes.cols(), 4);
}

TEST(Rechain, TwoCubicsAroundAnEllipseAreTheEllipse) {
  Sketch truth;
  const Vector3d centre(0.5, 0.5, 0.5), u(0.3, 0, 0), v(0, 0.15, 0.05);
  truth.add_stroke(StrokeKind::kEllipse, -1, -1, {centre, u, v});
  Sketch s;
  const int a = s.add_node(centre + u), b = s.add_node(centre - u);
  const double k = 4.0 / 3;
  s.add_stroke(StrokeKind::kBezier, a, b, {centre + u + k * v, centre - u + k * v});
  s.add_stroke(StrokeKind::kBezier, b, a, {centre - u - k * v, centre + u - k * v});
  const Rechained out = again(s, world_of(truth));
  ASSERT_EQ(out.sketch.size(), 1);
  EXPECT_EQ(out.sketch.strokes[0].kind, StrokeKind::kEllipse);
}

TEST(Rechain, CubicsOverAnArcOfAnEllipseAreThatArc) {
  Sketch truth;
  const Vector3d centre(0.5, 0.5, 0.5), u(0.3, 0, 0.1), v(0, 0.15, 0.05);
  add_elliptic_arc(&truth, centre, u, v, -0.4, 2.9);
  Sketch s;
  const auto at = [&](double a) { return Vector3d(centre + std::cos(a) * u + std::sin(a) * v); };
  const auto slope = [&](double a) { return Vector3d(std::cos(a) * v - std::sin(a) * u); };
  int last = s.add_node(at(-0.4));
  for (int k = 0; k < 3; ++k) {
    const double a = -0.4 + 1.1 * k, b = a + 1.1, h = 4.0 / 3 * std::tan(1.1 / 4);
    const int next = s.add_node(at(b));
    s.add_stroke(StrokeKind::kBezier, last, next, {at(a) + h * slope(a), at(b) - h * slope(b)});
    last = next;
  }
  const Rechained out = again(s, world_of(truth));
  ASSERT_EQ(out.sketch.size(), 1);
  EXPECT_EQ(out.sketch.strokes[0].kind, StrokeKind::kEllipticArc);
  EXPECT_EQ(out.sketch.nodes.cols(), 2);
  EXPECT_LT(farthest(out.sketch, 0, {polyline_of(truth, 0)}), 0.3 * 3.0 / 500);
}

TEST(Rechain, AnEllipseThatALineLeavesHasNoNodes) {
  const Vector3d centre(0.5, 0.4, 0.5), p(0.3, 0, 0), q(0, 0.15, 0.05);
  constexpr double kLast = 2 * M_PI - 0.05;
  const ControlPoints first = elliptic_arc(centre, p, q, 0, 3),
                      second = elliptic_arc(centre, p, q, 3, kLast);
  const Vector3d along = (-std::sin(kLast) * p + std::cos(kLast) * q).normalized();
  Sketch s;
  const int begin = s.add_node(first.p[0]), middle = s.add_node(first.p[3]);
  const int end = s.add_node(second.p[3]), tip = s.add_node(second.p[3] + 0.3 * along);
  s.add_stroke(StrokeKind::kEllipticArc, begin, middle, {first.p[1], first.p[2]});
  s.add_stroke(StrokeKind::kEllipticArc, middle, end, {second.p[1], second.p[2]});
  s.add_stroke(StrokeKind::kLine, end, tip, {});
  const Rechained out = again(s, world_of(s));
  EXPECT_EQ(out.changes, 1);
  EXPECT_TRUE(validate(out.sketch).empty());
  ASSERT_EQ(out.sketch.size(), 2);
  EXPECT_EQ(count_of(out.sketch, StrokeKind::kEllipse), 1);
  EXPECT_EQ(count_of(out.sketch, StrokeKind::kLine), 1);
  EXPECT_EQ(out.sketch.nodes.cols(), 2);
  const int line = out.sketch.strokes[0].kind == StrokeKind::kLine ? 0 : 1;
  EXPECT_NEAR(stroke_length(out.sketch, line), 0.3, 0.03);
}

TEST(Rechain, WhatIsDescribedWellStays) {
  const Sketch truth = rounded_corner();
  const EdgeWorld world = world_of(truth);
  const Rechained out = again(truth, world);
  EXPECT_EQ(out.changes, 0);
  EXPECT_EQ(out.sketch.size(), 3);
  EXPECT_EQ(again(Sketch(), world).sketch.size(), 0);
}

}  // namespace
}  // namespace sketchsplat
