// SPDX-License-Identifier: MIT
#include "pipelines/join/close_graph.h"

#include <gtest/gtest.h>

#include "sketches/curve/conic.h"
#include "tests/support/strokes.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;
const Vector3d kMiddle(0.5, 0.5, 0.5);

// A world whose images show `truth`; without masks.
EdgeWorld world_of(const Sketch& truth, int views = 12) {
  return ideal_world(ring_of_views(views, kMiddle, 3), polylines_of(truth));
}

Sketch frame() {
  Sketch s;
  add_line(&s, {0.2, 0.2, 0.5}, {0.8, 0.2, 0.5});
  return s;
}

class CloseGraph : public testing::Test {
 protected:
  CloseGraph() : world(world_of(frame())), px(world.footprint) {}
  Closed close(const Sketch& s) const { return close_graph(s, world, {}, {}); }
  const EdgeWorld world;
  const double px;
};

TEST_F(CloseGraph, TwoLooseEndsThatPointAtACornerShareIt) {
  Sketch s;
  add_line(&s, {0.2, 0.2, 0.5}, {0.8 - 5 * px, 0.2, 0.5});
  add_line(&s, {0.8, 0.2 + 4 * px, 0.5}, {0.8, 0.8, 0.5});
  const Closed c = close(s);
  ASSERT_EQ(c.sketch.size(), 2);
  EXPECT_TRUE(validate(c.sketch).empty());
  ASSERT_EQ(c.sketch.nodes.cols(), 3);
  EXPECT_EQ(c.sketch.strokes[0].end, c.sketch.strokes[1].begin);
  EXPECT_LT((point_at(c.sketch, 0, 1) - Vector3d(0.8, 0.2, 0.5)).norm(), px);
}

TEST_F(CloseGraph, AnEndOnAnothersInteriorSplitsItThere) {
  Sketch s = frame();
  add_line(&s, {0.5, 0.2 + 3 * px, 0.5}, {0.5, 0.8, 0.5});
  const Closed c = close(s);
  EXPECT_EQ(c.split, 1);
  ASSERT_EQ(c.sketch.size(), 3);
  EXPECT_TRUE(validate(c.sketch).empty());
  EXPECT_EQ(c.sketch.nodes.cols(), 4);
  double total = 0;
  for (int i = 0; i < 3; ++i) total += stroke_length(c.sketch, i);
  EXPECT_NEAR(total, 0.6 + 0.6, px);
}

TEST_F(CloseGraph, AnEndThatWentTooFarComesBack) {
  Sketch s = frame();
  add_line(&s, {0.8, 0.2 - 2 * px, 0.5}, {0.8, 0.8, 0.5});
  const Closed c = close(s);
  ASSERT_EQ(c.sketch.size(), 2);
  EXPECT_EQ(c.sketch.nodes.cols(), 3);
  EXPECT_NEAR(stroke_length(c.sketch, 1), 0.6, 0.5 * px);
}

TEST_F(CloseGraph, StrokesThatPassEachOtherStayApart) {
  Sketch s = frame();
  add_line(&s, {0.5, 0.2 + 3 * px, 0.5 + 4 * px}, {0.5, 0.8, 0.5 + 4 * px});  // above
  add_line(&s, {0.3, 0.2 + 20 * px, 0.5}, {0.3, 0.8, 0.5});                   // too far
  add_line(&s, {0.1, 0.2 + 3 * px, 0.5}, {0.2 - 3 * px, 0.2 + 3 * px, 0.5});  // beside
  const Closed c = close(s);
  EXPECT_EQ(c.joined, 0);
  EXPECT_EQ(c.sketch.size(), 4);
  EXPECT_EQ(c.sketch.nodes.cols(), 8);
}

TEST_F(CloseGraph, AnArcThatGoesOnKeepsItsCircle) {
  Sketch s = frame();
  const double r = 0.2;
  const auto on = [&](double deg) {
    const double a = deg * M_PI / 180;
    return Vector3d(0.5 + r * std::cos(a), 0.2 + r * std::sin(a), 0.5);
  };
  const double short_of = 3 * px / r * 180 / M_PI;
  add_arc(&s, on(short_of), on(90), on(180 - short_of));
  const Closed c = close(s);
  EXPECT_EQ(c.joined, 2);
  ASSERT_EQ(c.sketch.size(), 4);  // the line in three, and the arc
  for (int i = 0; i < c.sketch.size(); ++i) {
    if (c.sketch.strokes[i].kind != StrokeKind::kArc) continue;
    const CircleParameters p = circle_parameters(c.sketch, i);
    EXPECT_NEAR(p.radius, r, 0.2 * px);
    EXPECT_LT((p.centre - Vector3d(0.5, 0.2, 0.5)).norm(), 0.2 * px);
  }
}

TEST_F(CloseGraph, AnArcOfNearlyACircleIsTheCircleUnlessSomethingEndsThere) {
  Sketch s;
  const auto on = [](double deg) {
    const double a = deg * M_PI / 180;
    return Vector3d(0.5 + 0.2 * std::cos(a), 0.5 + 0.2 * std::sin(a), 0.5);
  };
  const double gap = 6 * px / 0.2 * 180 / M_PI;
  add_arc(&s, on(gap / 2), on(180), on(360 - gap / 2));
  const Closed c = close(s);
  ASSERT_EQ(c.sketch.size(), 1);
  ASSERT_EQ(c.sketch.strokes[0].kind, StrokeKind::kCircle);
  EXPECT_NEAR(c.sketch.handles.col(1).norm(), 0.2, 0.1 * px);

  const int outside = s.add_node({0.9, 0.5, 0.5});
  s.add_stroke(StrokeKind::kLine, s.strokes[0].begin, outside, {});
  EXPECT_EQ(close(s).rounded, 0);
}

TEST_F(CloseGraph, TwoArcsThatGoOnAroundNearlyACircleAreTheCircle) {
  const auto on = [&](double deg, double radius) {
    const double a = deg * M_PI / 180;
    return Vector3d(0.5 + radius * std::cos(a), 0.5 + radius * std::sin(a), 0.5);
  };
  const double last = 360 - 5 * px / 0.2 * 180 / M_PI;
  for (const double other : {0.2 + 0.3 * px, 0.2 + 40 * px}) {  // radius half-way
    Sketch t;
    const int a = t.add_node(on(0, 0.2)), b = t.add_node(on(190, 0.2)),
              c = t.add_node(on(last, 0.2));
    t.add_stroke(StrokeKind::kArc, a, b, {on(95, 0.2)});
    t.add_stroke(StrokeKind::kArc, c, b, {on((190 + last) / 2, other)});
    const Closed closed = close(t);
    const bool one = other < 0.2 + px;
    EXPECT_EQ(closed.rounded, one);
    ASSERT_EQ(closed.sketch.size(), one ? 1 : 2);
    EXPECT_EQ(closed.sketch.strokes[0].kind, one ? StrokeKind::kCircle : StrokeKind::kArc);
  }
}

// About (0.5, 0.5, 0.5).
Vector3d on_circle(double deg, double radius) {
  const double a = deg * M_PI / 180;
  return Vector3d(0.5 + radius * std::cos(a), 0.5 + radius * std::sin(a), 0.5);
}

TEST_F(CloseGraph, TwoArcsThatFaceEachOtherOverTwoGapsAreTheirCircle) {
  const double r = 0.2, gap = 5 * px / r * 180 / M_PI;
  for (const double other : {r + 0.1 * px, r + 30 * px}) {
    Sketch s;
    add_arc(&s, on_circle(0, r), on_circle(60, r), on_circle(120, r));
    add_arc(&s, on_circle(360 - gap, other), on_circle(240, other), on_circle(120 + gap, other));
    const bool one = other < r + px;
    const Closed c = close(s);
    EXPECT_EQ(c.rounded, one);
    ASSERT_EQ(c.sketch.size(), one ? 1 : 2);
    EXPECT_EQ(c.sketch.strokes[0].kind, one ? StrokeKind::kCircle : StrokeKind::kArc);
  }
  Sketch part;  // where masks say that views must see the rest, and they do not
  add_arc(&part, on_circle(0, r), on_circle(50, r), on_circle(100, r));
  add_arc(&part, on_circle(180, r), on_circle(215, r), on_circle(250, r));
  EXPECT_EQ(close_graph(part, world_of(part, 40), {}, {}).rounded, 0);
}

// Where the views show all of the circle, each arc alone could be all of it, too.
TEST_F(CloseGraph, TwoArcsOfACircleThatViewsShowAreOneCircleNotTwo) {
  Sketch shown, arcs;
  shown.add_stroke(StrokeKind::kCircle, -1, -1, {{0.5, 0.5, 0.5}, {0, 0, 0.2}});
  add_arc(&arcs, on_circle(5, 0.2), on_circle(90, 0.2), on_circle(175, 0.2));
  add_arc(&arcs, on_circle(185, 0.2), on_circle(270, 0.2), on_circle(355, 0.2));
  const Closed c = close_graph(arcs, world_of(shown, 40), {}, {});
  ASSERT_EQ(c.sketch.size(), 1);
  EXPECT_EQ(c.sketch.strokes[0].kind, StrokeKind::kCircle);
}

TEST_F(CloseGraph, APieceOfACircleDrawnTwiceIsTheCircleUnlessSomethingEndsThere) {
  for (const double off : {0.1 * px, 4 * px}) {
    const double r = 0.2 + off;
    Sketch s;
    s.add_stroke(StrokeKind::kCircle, -1, -1, {{0.5, 0.5, 0.5}, {0, 0, 0.2}});
    add_arc(&s, on_circle(20, r), on_circle(40, r), on_circle(60, r));
    EXPECT_EQ(close(s).sketch.size(), off < px ? 1 : 2);
    s.add_stroke(StrokeKind::kLine, s.strokes[1].end, s.add_node({0.9, 0.9, 0.5}), {});
    EXPECT_EQ(close(s).sketch.size(), 3);
  }
}

// With masks, a gap is closed if no view contradicts; without any, if it is narrow.
TEST_F(CloseGraph, ArcsOfNearlyAnEllipseAreTheEllipseUnlessSomethingEndsThere) {
  const Vector3d centre(0.5, 0.5, 0.5), p(0.3, 0, 0.1), q(0, 0.15, 0);
  const double narrow = 2 * M_PI - 3 * px / 0.3;
  Sketch s;  // in two pieces that share a node, the second one backwards
  const ControlPoints a = elliptic_arc(centre, p, q, 0, 3),
                      b = elliptic_arc(centre, p, q, 3, narrow);
  const int begin = s.add_node(a.p[0]), joint = s.add_node(a.p[3]), end = s.add_node(b.p[3]);
  s.add_stroke(StrokeKind::kEllipticArc, begin, joint, {a.p[1], a.p[2]});
  s.add_stroke(StrokeKind::kEllipticArc, end, joint, {b.p[1], b.p[2]});
  const Closed c = close(s);
  ASSERT_EQ(c.sketch.size(), 1);
  EXPECT_EQ(c.rounded, 1);
  ASSERT_EQ(c.sketch.strokes[0].kind, StrokeKind::kEllipse);
  EXPECT_LT((c.sketch.handles.col(0) - centre).norm(), 0.1 * px);
  EXPECT_TRUE(validate(c.sketch).empty());
  Sketch held = s;
  held.add_stroke(StrokeKind::kLine, joint, held.add_node({0.1, 0.1, 0.9}), {});
  EXPECT_EQ(close(held).rounded, 0);
  Sketch half;  // too little of it
  add_elliptic_arc(&half, centre, p, q, 0, 3);
  EXPECT_EQ(close(half).rounded, 0);
}

TEST_F(CloseGraph, WithoutMasksWideGapsStayOpenUnlessAnEdgeIsSeenThere) {
  Sketch s;
  add_line(&s, {0.2, 0.2, 0.5}, {0.35, 0.2, 0.5});
  add_line(&s, {0.65, 0.2, 0.5}, {0.8, 0.2, 0.5});
  EXPECT_EQ(close_graph(s, world_of(s, 40), {}, {}).bridged, 0);
  EXPECT_EQ(close_graph(s, world_of(frame(), 40), {}, {}).bridged, 1);
  Sketch near;
  add_line(&near, {0.2, 0.2, 0.5}, {0.5, 0.2, 0.5});
  add_line(&near, {0.5 + 6 * px, 0.2, 0.5}, {0.8, 0.2, 0.5});
  const Closed c = close_graph(near, world_of(near), {}, {});
  EXPECT_EQ(c.bridged, 1);
  ASSERT_EQ(c.sketch.size(), 1);
  EXPECT_NEAR(stroke_length(c.sketch, 0), 0.6, 1e-9);
  EXPECT_EQ(close(c.sketch).bridged, 0);
}

TEST_F(CloseGraph, PiecesOfTwoLinesAreNotOne) {
  Sketch s;
  add_line(&s, {0.2, 0.2, 0.5}, {0.5, 0.2, 0.5});
  add_line(&s, {0.5 + 6 * px, 0.2 + 3 * px, 0.5}, {0.8, 0.2 + 3 * px, 0.5});
  EXPECT_EQ(close(s).bridged, 0);
}

TEST_F(CloseGraph, EndsThatNothingElseHoldsAreCounted) {
  Sketch s;
  EXPECT_EQ(count_loose_ends(s, px), 0);
  const int corner = s.add_node({0.5, 0.2, 0.5});
  s.add_stroke(StrokeKind::kLine, s.add_node({0.2, 0.2, 0.5}), corner, {});
  s.add_stroke(StrokeKind::kLine, corner, s.add_node({0.5, 0.6, 0.5}), {});
  EXPECT_EQ(count_loose_ends(s, px), 2);
  add_circle(&s, {0.5, 0.7, 0.5}, {0, 0, 0.1});  // the second line ends on it
  EXPECT_EQ(count_loose_ends(s, px), 1);
}

TEST_F(CloseGraph, NothingMakesNothing) { EXPECT_EQ(close(Sketch()).sketch.size(), 0); }

}  // namespace
}  // namespace sketchsplat
