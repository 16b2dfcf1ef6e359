// SPDX-License-Identifier: MIT
#include "sketches/curve/closest.h"
#include "sketches/curve/conic.h"
#include "tests/topology/build_sketch.h"
#include "topology/core/refit.h"

namespace sketchsplat {
namespace {

// Of the ellipse about the origin with semi-axes 60 and 30 px, tilted; degrees of its angle.
const Vector3d kU = 60 * Vector3d(0.8, 0, 0.6), kV = 30 * Vector3d(0, 1, 0);

int add_elliptic(Sketch* s, const Vector3d& u, const Vector3d& v, double from_deg, double to_deg,
                 bool back = false) {
  const ControlPoints c = elliptic_arc({0, 0, 0}, u, v, from_deg * M_PI / 180, to_deg * M_PI / 180);
  const int a = s->add_node(c.p[0]), b = s->add_node(c.p[3]);
  return s->add_stroke(StrokeKind::kEllipticArc, back ? b : a, back ? a : b, {c.p[1], c.p[2]});
}

double off_ellipse(const Sketch& s, int stroke) {
  const Vector3d whole[3] = {{0, 0, 0}, kU, kV};
  double worst = 0;
  Vector3d p, d;
  for (int k = 0; k <= 20; ++k) {
    evaluate_stroke(s, stroke, k / 20.0, &p, &d);
    worst = std::max(worst, closest_on_curve(StrokeKind::kEllipse, whole, p).distance);
  }
  return worst;
}

TEST(EllipticArcs, OfOneEllipseBecomeOneArcWhicheverWayTheyRun) {
  for (bool back : {false, true}) {
    Sketch s;
    add_elliptic(&s, kU, kV, 10, 120);
    add_elliptic(&s, kU, kV, 123, 230, back);
    const PassResult r = merge_collinear(s, one_pixel());
    expect_sound(r, s);
    ASSERT_EQ(r.sketch.size(), 1) << back;
    EXPECT_EQ(r.sketch.strokes[0].kind, StrokeKind::kEllipticArc);
    EXPECT_LT(off_ellipse(r.sketch, 0), 0.01);
    Sketch whole;
    add_elliptic(&whole, kU, kV, 10, 230);
    EXPECT_NEAR(stroke_length(r.sketch, 0), stroke_length(whole, 0), 0.1);
  }
}

TEST(EllipticArcs, OfAFullTurnBecomeAnEllipse) {
  Sketch s;
  add_elliptic(&s, kU, kV, 0, 178);
  add_elliptic(&s, kU, kV, 181, 358, true);
  const PassResult r = merge_collinear(s, one_pixel());
  expect_sound(r, s);
  ASSERT_EQ(r.sketch.size(), 1);
  EXPECT_EQ(r.sketch.strokes[0].kind, StrokeKind::kEllipse);
  EXPECT_LT(off_ellipse(r.sketch, 0), 0.01);
}

TEST(EllipticArcs, OfTwoEllipsesStayApart) {
  Sketch s;
  add_elliptic(&s, kU, kV, 0, 90);
  add_elliptic(&s, -0.6 * kU, kV, -90, 90);
  EXPECT_EQ(merge_collinear(s, one_pixel()).sketch.size(), 2);
}

TEST(EllipticArcs, KeepTheirShapeWhenTheirEndsMove) {
  Sketch s;
  add_elliptic(&s, kU, kV, 20, 170);
  const ControlPoints c = control_points(s, 0);
  const PlainCurve curve = plain_curve(s, 0);
  const Vector3d a = c.p[0] + Vector3d(1, -0.5, 0.3), b = c.p[3] + Vector3d(-0.4, 1, 0.2);
  const PlainCurve moved = move_ends(curve, a, b);
  EXPECT_EQ(moved.begin(), a);
  EXPECT_EQ(moved.end(), b);
  EXPECT_LT(max_distance(curve, sample_curve(moved).position), 1.2);
  const PlainCurve back = backwards(curve);
  EXPECT_EQ(back.begin(), curve.end());
  EXPECT_LT(max_distance(curve, sample_curve(back).position), 1e-4);
}

}  // namespace
}  // namespace sketchsplat
