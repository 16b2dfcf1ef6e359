// SPDX-License-Identifier: MIT
#include "sketches/curve/closest.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sketches/curve/curve.h"
#include "tests/sketches/five_kinds.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

double brute_force(StrokeKind kind, const Vector3d* c, const Vector3d& p) {
  double best = 1e300;
  for (int i = 0; i <= 20000; ++i) {
    Vector3d x, d;
    evaluate_curve<double>(kind, c, i / 20000.0, &x, &d);
    best = std::min(best, (x - p).norm());
  }
  return best;
}

TEST(DistanceToStroke, AgreesWithBruteForceForAllKinds) {
  Random random;
  const Sketch s = all_kinds();
  for (int i = 0; i < s.size(); ++i)
    for (int k = 0; k < 40; ++k) {
      const Vector3d p = 1.5 * random.point();
      const ClosestPoint closest = distance_to_stroke(s, i, p);
      const double expected = brute_force(s.strokes[i].kind, control_points(s, i).p.data(), p);
      EXPECT_LE(closest.distance, expected + 1e-12) << kind_name(s.strokes[i].kind);
      EXPECT_GE(closest.distance, expected - 1e-6) << kind_name(s.strokes[i].kind);
      EXPECT_GE(closest.t, 0);
      EXPECT_LE(closest.t, 1);
      Vector3d x, d;
      evaluate_stroke(s, i, closest.t, &x, &d);
      EXPECT_EQ(x, closest.position);
    }
}

TEST(DistanceToStroke, IsZeroOnTheCurveAndFindsTheParameter) {
  const Sketch s = all_kinds();
  for (int i = 0; i < s.size(); ++i)
    for (double t : {0.0, 0.13, 0.5, 0.77, 1.0}) {
      Vector3d x, d;
      evaluate_stroke(s, i, t, &x, &d);
      const ClosestPoint closest = distance_to_stroke(s, i, x);
      EXPECT_LT(closest.distance, 1e-14) << kind_name(s.strokes[i].kind) << " at " << t;
      const double turns = closest.t - t;
      EXPECT_NEAR(is_closed(s.strokes[i].kind) ? std::remainder(turns, 1.0) : turns, 0, 1e-7);
    }
}

TEST(DistanceToStroke, HoldsForThinEllipses) {
  Random random;
  for (double thickness : {1e-1, 1e-3, 1e-6, 1e-14}) {
    const Vector3d c[3] = {{0, 0, 0}, {1, 0, 0}, {0, thickness, 0}};
    for (int k = 0; k < 30; ++k) {
      const Vector3d p = random.point() * (k % 2 ? 1.0 : 0.01);
      const double found = closest_on_curve(StrokeKind::kEllipse, c, p).distance;
      EXPECT_NEAR(found, brute_force(StrokeKind::kEllipse, c, p), 1e-4);
      EXPECT_LE(found, brute_force(StrokeKind::kEllipse, c, p) + 1e-9);
    }
  }
}

TEST(DistanceToStroke, HoldsForNearlyStraightArcs) {
  for (double sagitta : {1e-2, 1e-4, 1e-7, 1e-9, 1e-12, 0.0}) {
    const Vector3d c[3] = {{0, 0, 0}, {0.5, sagitta, 0}, {1, 0, 0}};
    const ClosestPoint closest = closest_on_curve(StrokeKind::kArc, c, {0.3, 0.1 + sagitta, 0});
    EXPECT_NEAR(closest.distance, 0.1, 0.17 * sagitta + 1e-12);
    EXPECT_NEAR(closest.t, 0.3, sagitta + 1e-9);
    EXPECT_EQ(closest_on_curve(StrokeKind::kArc, c, {-1, 0.1, 0}).t, 0);
    EXPECT_EQ(closest_on_curve(StrokeKind::kArc, c, {2, 0.1, 0}).t, 1);
  }
}

TEST(DistanceToStroke, IsFiniteWhereEveryPointIsNearestAndForDegenerateCurves) {
  const Vector3d o(0, 0, 0), e(1, 0, 0);
  const struct {
    StrokeKind kind;
    Vector3d c[4];
    double from_origin;
  } cases[] = {{StrokeKind::kLine, {o, o}, 0},
               {StrokeKind::kArc, {o, o, o}, 0},
               {StrokeKind::kArc, {o, e, o}, 0},
               {StrokeKind::kCircle, {o, e}, 1},
               {StrokeKind::kCircle, {o, o}, 0},
               {StrokeKind::kEllipse, {o, e, {0, 1, 0}}, 1},
               {StrokeKind::kEllipse, {o, e, {0, 0.5, 0}}, 0.5},
               {StrokeKind::kEllipse, {o, e, e}, 0},
               {StrokeKind::kEllipse, {o, o, o}, 0},
               {StrokeKind::kEllipticArc, {o, o, o, o}, 0},
               {StrokeKind::kEllipticArc, {-e, {0, 1, 0}, {0, std::sqrt(0.5), 0}, e}, 1},
               {StrokeKind::kBezier, {o, o, o, o}, 0},
               {StrokeKind::kBezier, {e, e, -e, -e}, 0}};
  for (const auto& c : cases) {
    const ClosestPoint closest = closest_on_curve(c.kind, c.c, o);
    EXPECT_NEAR(closest.distance, c.from_origin, 1e-9) << kind_name(c.kind);
    EXPECT_TRUE(std::isfinite(closest.t));
    EXPECT_TRUE(closest_on_curve(c.kind, c.c, Vector3d(0.2, 0.3, 0.4)).position.allFinite());
  }
}

}  // namespace
}  // namespace sketchsplat
