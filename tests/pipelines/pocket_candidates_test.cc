// SPDX-License-Identifier: MIT
// A pocket in a plate, of which only the rim is known, seen from above by few views that look into
// it; and the same square as a print on the plate.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "pipelines/candidates/add_missing.h"
#include "sketches/curve/curve.h"
#include "tests/support/painted.h"
#include "tests/support/wireframe.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;

constexpr double kDistance = 2.5;
constexpr double kHalf = 0.1, kDepth = 0.13;  // of the pocket

// Grey level of what a ray from above meets: a plate at z = 0 with a pocket around the origin, or,
// of depth 0, the print of one.
double level_of(const Vector3d& eye, const Vector3d& ray, double depth) {
  const Vector3d top = eye - ray * (eye.z() / ray.z());
  if (std::max(std::abs(top.x()), std::abs(top.y())) > kHalf) return 150;
  if (!(depth > 0)) return 120;
  double near = (-depth - eye.z()) / ray.z(), level = 128;  // the floor
  const double walls[] = {95, 110, 135, 142};
  for (int k = 0; k < 4; ++k) {
    const int axis = k % 2;
    const double side = k < 2 ? kHalf : -kHalf, t = (side - eye[axis]) / ray[axis];
    if (t * ray.z() + eye.z() > 0 || !(t > 0) || t > near) continue;
    near = t, level = walls[k];
  }
  return level;
}

EdgeWorld world_of(double depth) {
  std::vector<View> views;
  for (const View& view : ring_of_views(60, Vector3d::Zero(), kDistance))
    if (view.center_in_world().z() >= 0.1 * kDistance) views.push_back(view);
  const auto level = [&](const Vector3d& eye, const Vector3d& ray, int) {
    return level_of(eye, ray, depth);
  };
  return painted(views, kDistance / 500, level, 2, 1);
}

void add_square(double half, double height, Sketch* s) {
  int n[4];
  for (int k = 0; k < 4; ++k)
    n[k] = s->add_node({k == 1 || k == 2 ? half : -half, k > 1 ? half : -half, height});
  for (int k = 0; k < 4; ++k) s->add_stroke(StrokeKind::kLine, n[k], n[(k + 1) % 4], {});
}

// The plate is larger than the pictures.
Sketch rims() {
  Sketch s;
  add_square(0.35, 0, &s);
  add_square(0.35, -0.3, &s);
  add_square(kHalf, 0, &s);
  return s;
}

void expect_pocket(const MissingEdges& missing) {
  const double px = kDistance / 500;
  int floor = 0, walls = 0;
  for (int s = rims().size(); s < missing.sketch.size(); ++s) {
    const ControlPoints c = control_points(missing.sketch, s);
    double low = std::min(c.p[0].z(), c.p[1].z()), high = std::max(c.p[0].z(), c.p[1].z());
    EXPECT_NEAR(low, -kDepth, 2 * px);
    for (const Vector3d& p : {c.p[0], c.p[1]}) {
      EXPECT_NEAR(std::abs(p.x()), kHalf, 1e-6);
      EXPECT_NEAR(std::abs(p.y()), kHalf, 1e-6);
    }
    (high > -px ? walls : floor) += 1;
  }
  ASSERT_GE(missing.corners.size(), 4u);
  for (const Vector3d& p : missing.corners) EXPECT_NEAR(p.z(), -kDepth, 2 * px);
  EXPECT_EQ(floor, 4);
  EXPECT_EQ(walls, 4);
  for (const int g : missing.group) {
    EXPECT_GE(g, 0) << "one of a group";
    EXPECT_LT(g, int(missing.known.size()));
  }
}

TEST(PocketCandidates, FloorAndWallsAreFoundWhereViewsSeeThemThroughTheRim) {
  expect_pocket(add_missing(rims(), world_of(kDepth), {}));
}

TEST(PocketCandidates, PiecesOfWallsThatAreKnownTellOfThePocketAndGiveWayToTheWholeOnes) {
  Sketch s = rims();
  for (const double side : {-kHalf, kHalf}) {
    const int begin = s.add_node({side, kHalf, 0}), end = s.add_node({side, kHalf, -0.6 * kDepth});
    s.add_stroke(StrokeKind::kLine, begin, end, {});
  }
  expect_pocket(add_missing(s, world_of(kDepth), {}));
}

TEST(PocketCandidates, WallsWithoutAFloorTellNoDepth) {
  EXPECT_EQ(add_missing(rims(), world_of(1), {}).sketch.size(), rims().size());
}

TEST(PocketCandidates, APrintedSquareHasNoFloor) {
  EXPECT_EQ(add_missing(rims(), world_of(0), {}).sketch.size(), rims().size());
}

TEST(Window, LetsThroughWhatPassesInsideOfItsLoopFromTheOtherSide) {
  Eigen::Matrix3Xd square(3, 5), circle(3, 61);
  square << 0, 2, 2, 0, 0, 0, 0, 2, 2, 0, 1, 1, 1, 1, 1;
  for (int k = 0; k <= 60; ++k)
    circle.col(k) << 1 + 0.3 * std::cos(k * M_PI / 30), 1 + 0.3 * std::sin(k * M_PI / 30), 1;
  const std::vector<Eigen::Matrix3Xd> sides = {square.leftCols(3), square.rightCols(3)};
  const Window window(Vector3d(0, 0, -7), sides);
  const Vector3d inside(1, 1, 0), above(1, 1, 5), aslant(9, 1, 2);
  EXPECT_TRUE(window.lets_through(inside, above));
  EXPECT_TRUE(window.lets_through(above, inside));
  EXPECT_FALSE(window.lets_through(inside, aslant)) << "the plane hides it";
  EXPECT_FALSE(window.lets_through(inside, Vector3d(1, 1, 0.5))) << "on one side of the plane";
  const Window ring(Vector3d::UnitZ(), {square, circle});
  EXPECT_FALSE(ring.lets_through(inside, above)) << "an island in the opening";
  EXPECT_TRUE(ring.lets_through(Vector3d(0.3, 0.3, 0), Vector3d(0.3, 0.3, 5)));
  EXPECT_TRUE(any_lets_through({ring, window}, inside, above));
  EXPECT_FALSE(any_lets_through({}, inside, above));
}

TEST(Window, OfOneSideOfAPlaneIsOpenToTheCamerasThere) {
  const Vector3d rim(1, 1, 1);
  const Window top = Window::one_side(Vector3d(0, 0, 3), rim);
  const Window bottom = Window::one_side(Vector3d(0, 0, -3), rim);
  EXPECT_TRUE(top.lets_through(rim, Vector3d(9, 1, 1.1)));
  EXPECT_FALSE(bottom.lets_through(rim, Vector3d(9, 1, 1.1)));
  EXPECT_FALSE(top.lets_through(rim, Vector3d(1, 1, 0)));
  EXPECT_TRUE(bottom.lets_through(rim, Vector3d(1, 1, 0)));
}

}  // namespace
}  // namespace sketchsplat
