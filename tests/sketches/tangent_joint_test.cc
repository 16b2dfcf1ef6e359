// SPDX-License-Identifier: MIT
#include "sketches/curve/tangent_joint.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sketches/solve/relations.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;
constexpr double kDegree = M_PI / 180;

// A line, and an arc of 90 degrees that turns by so much where it goes on from it, and leaves its
// plane by so much.
Sketch line_and_arc(double turn_deg, double out_deg = 0) {
  const Vector3d along(std::cos(turn_deg * kDegree), std::sin(turn_deg * kDegree), 0);
  const Vector3d aside = std::cos(out_deg * kDegree) * Vector3d(-along.y(), along.x(), 0) +
                         std::sin(out_deg * kDegree) * Vector3d::UnitZ();
  Sketch s;
  const int a = s.add_node({-2, 0, 0}), b = s.add_node({0, 0, 0}), c = s.add_node(along + aside);
  s.add_stroke(StrokeKind::kLine, a, b, {});
  s.add_stroke(StrokeKind::kArc, c, b, {std::sqrt(0.5) * along + (1 - std::sqrt(0.5)) * aside});
  return s;
}

TEST(TangentJoint, IsWhereAnArcGoesOnFromALineOrNearlyDoes) {
  const auto joints = find_tangent_joints(line_and_arc(0), 1 * kDegree);
  ASSERT_EQ(joints.size(), 1u);
  EXPECT_EQ(joints[0].node, 1);
  EXPECT_EQ(joints[0].arc, 1);
  EXPECT_EQ(joints[0].other, 0);
  EXPECT_EQ(find_tangent_joints(line_and_arc(9), 10 * kDegree).size(), 1u);
  EXPECT_TRUE(find_tangent_joints(line_and_arc(11), 10 * kDegree).empty());
  EXPECT_TRUE(find_tangent_joints(line_and_arc(180), 10 * kDegree).empty()) << "it comes back";
}

TEST(TangentJoint, TurnsByTheAnglesOfItsResiduals) {
  for (const double turn : {0.0, 3.0, 8.0}) {
    const Sketch s = line_and_arc(turn);
    const std::vector<Relation> relations = tangent_relations(s, 10 * kDegree);
    ASSERT_EQ(relations.size(), 1u);
    const Eigen::VectorXd r = linearize(s, {}, relations[0]).residual;
    ASSERT_EQ(r.size(), 2);
    EXPECT_NEAR(std::abs(r[0]), std::sin(turn * kDegree), 1e-9);
    EXPECT_NEAR(r[1], 0, 1e-9) << "out of the plane";
  }
}

TEST(TangentJoint, IsInOnePlaneAndOfTwoStrokesOnly) {
  EXPECT_EQ(find_tangent_joints(line_and_arc(0, 30), 10 * kDegree).size(), 1u) << "a line has none";
  Sketch two = line_and_arc(0);
  const int far = two.add_node({-1, 0, 1});
  two.add_stroke(StrokeKind::kLine, 1, far, {});
  EXPECT_TRUE(find_tangent_joints(two, 10 * kDegree).empty()) << "three end there";
  Sketch saddle = line_and_arc(0);  // an arc instead of the line, in a plane across
  saddle.strokes[0].kind = StrokeKind::kArc;
  saddle.strokes[0].handle = int(saddle.handles.cols());
  saddle.handles.conservativeResize(3, saddle.handles.cols() + 1);
  saddle.handles.rightCols(1) = Vector3d(-1, 0, 0.05);
  EXPECT_TRUE(find_tangent_joints(saddle, 10 * kDegree).empty());
  saddle.handles.rightCols(1) = Vector3d(-1, -0.05, 0);
  EXPECT_EQ(find_tangent_joints(saddle, 10 * kDegree).size(), 1u) << "an S in one plane";
}

TEST(TangentJoint, ADiscOfALineAndAnArcHasNone) {
  Sketch s;
  const int a = s.add_node({0, 0, 0}), b = s.add_node({1, 0, 0});
  s.add_stroke(StrokeKind::kLine, a, b, {});
  s.add_stroke(StrokeKind::kArc, a, b, {Vector3d(0.5, 0.01, 0)});
  EXPECT_TRUE(find_tangent_joints(s, 20 * kDegree).empty());
}

}  // namespace
}  // namespace sketchsplat
