// SPDX-License-Identifier: MIT
#include "pipelines/adjust/polish_tangent.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pipelines/adjust/regularize.h"
#include "sketches/curve/conic.h"
#include "sketches/curve/curve.h"
#include "tests/support/noisy_world.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT

constexpr double kRadius = 0.3;  // 50 px

// Two lines and the arcs at their ends: one goes on from them, the other turns by `kink_deg`.
Sketch slot(double kink_deg) {
  Sketch s;
  const Vector3d axis = Vector3d(1, 2, 5).normalized();
  Vector3d x, y;
  frame_of<double>(axis, &x, &y);
  int node[4];
  for (int k = 0; k < 4; ++k)
    node[k] = s.add_node(kMiddle + (k % 2 ? 0.3 : -0.3) * x + (k / 2 ? kRadius : -kRadius) * y);
  s.add_stroke(StrokeKind::kLine, node[0], node[1], {});
  s.add_stroke(StrokeKind::kLine, node[2], node[3], {});
  s.add_stroke(StrokeKind::kArc, node[0], node[2], {Vector3d(kMiddle - (0.3 + kRadius) * x)});
  const double sagitta = kRadius * std::tan((90 - kink_deg) / 2 * M_PI / 180);
  s.add_stroke(StrokeKind::kArc, node[1], node[3], {Vector3d(kMiddle + (0.3 + sagitta) * x)});
  return s;
}

// Between a line and an arc, in their node.
double turn_deg(const Sketch& s, int line, int arc) {
  const Stroke &l = s.strokes[line], &a = s.strokes[arc];
  const bool at_end = l.end == a.begin || l.end == a.end;
  const int node = at_end ? l.end : l.begin;
  const Vector3d u = tangent_out(s, line, node), v = tangent_out(s, arc, node);
  return std::atan2(u.cross(v).norm(), -u.dot(v)) * 180 / M_PI;
}

// Drawn as after a coarse segmentation: arcs reach along their lines.
Sketch overdrawn(const Sketch& truth, double by) {
  Sketch s = truth;
  const Vector3d along = (truth.nodes.col(1) - truth.nodes.col(0)).normalized();
  for (int n = 0; n < 4; ++n) s.nodes.col(n) += (n % 2 ? -by : by) * along;
  return s;
}

PolishOptions last_options() {
  PolishOptions options;
  options.smooth_sigma_deg = 0.02;
  options.final_reach_px = 0.3;
  options.final_reach = 3;
  return options;
}

TEST(PolishTangent, ArcsThatReachAlongTheirLinesComeBackAndHaveTheirRadius) {
  const Sketch truth = slot(0);
  const EdgeWorld world = noisy_world(truth, 12, 3);
  Observation last;
  const Sketch free = polish(overdrawn(truth, 0.03), world, last_options(), &last);
  const Sketch held = polish_tangent(overdrawn(truth, 0.03), world, last_options(), {}, &last);
  for (const int arc : {2, 3}) {
    EXPECT_GT(turn_deg(free, 0, arc), 1) << "else this test tells nothing";
    for (const int line : {0, 1}) EXPECT_LT(turn_deg(held, line, arc), 0.1);
    EXPECT_NEAR(circle_parameters(held, arc).radius, kRadius, 0.2 * world.footprint);
  }
}

TEST(PolishTangent, AnArcThatTurnsWhereItMeetsItsLinesIsNotHeld) {
  for (const double kink : {12.0, 18.0}) {
    const Sketch truth = slot(kink);
    const EdgeWorld world = noisy_world(truth, 12, 3);
    Observation last;
    const Sketch held = polish_tangent(overdrawn(truth, 0.01), world, last_options(), {}, &last);
    const Regularized all = regularize(held, with_strokes(last, world, 1), world.footprint, {});
    for (const Sketch& s : {held, all.sketch})
      for (const int line : {0, 1}) {
        EXPECT_LT(turn_deg(s, line, 2), 0.1);
        EXPECT_NEAR(turn_deg(s, line, 3), kink, 3);
      }
    int tangent = 0;
    for (const Regularity& r : all.kept)
      if (r.kind == RelationKind::kTangent) {
        ++tangent;
        EXPECT_EQ(r.strokes.back(), 2);
      }
    EXPECT_EQ(tangent, 2);
  }
}

TEST(PolishTangent, WithoutArcsItIsPolish) {
  const Sketch truth = box();
  const EdgeWorld world = noisy_world(truth, 8, 1);
  Observation a, b;
  const Sketch one = polish(truth, world, last_options(), &a),
               other = polish_tangent(truth, world, last_options(), {}, &b);
  EXPECT_EQ(one.nodes, other.nodes);
  EXPECT_EQ(a.matches.first, b.matches.first);
}

}  // namespace
}  // namespace sketchsplat
