// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>

#include "pipelines/candidates/add_missing.h"
#include "pipelines/candidates/level_copies.h"
#include "pipelines/candidates/level_rings.h"
#include "pipelines/candidates/pattern_copies.h"
#include "tests/support/wireframe.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

constexpr double kTolerance = 0.01;

void add_circle(const Vector3d& centre, double radius, Sketch* s) {
  s->add_stroke(StrokeKind::kCircle, -1, -1, {centre, radius * Vector3d::UnitZ()});
}

void add_square(double height, Sketch* s) {
  std::vector<int> n;
  for (int k = 0; k < 4; ++k)
    n.push_back(s->add_node({k == 1 || k == 2 ? 1.0 : 0.0, k > 1 ? 1.0 : 0.0, height}));
  for (int k = 0; k < 4; ++k) s->add_stroke(StrokeKind::kLine, n[k], n[(k + 1) % 4], {});
}

// A plate of height 0.2 with a hole of which one rim is known.
Sketch plate() {
  Sketch s;
  add_square(0, &s);
  add_square(0.2, &s);
  add_circle({0.2, 0.3, 0.2}, 0.1, &s);
  return s;
}

bool has_circle(const std::vector<Candidate>& candidates, const Vector3d& centre, double radius) {
  for (const Candidate& c : candidates)
    if (c.kind == StrokeKind::kCircle && (c.curve.p[0] - centre).norm() < 1e-9 &&
        std::abs(c.curve.p[1].norm() - radius) < 1e-9)
      return true;
  return false;
}

TEST(Candidates, TheOtherRimOfAHoleLiesInTheOtherLevelOfThePlate) {
  const Sketch s = plate();
  const std::vector<Levels> levels = find_levels(s, kTolerance);
  ASSERT_FALSE(levels.empty());
  EXPECT_NEAR(std::abs(levels[0].normal.z()), 1, 1e-9);
  EXPECT_EQ(levels[0].height.size(), 2);
  EXPECT_TRUE(has_circle(level_copies(s, levels), {0.2, 0.3, 0}, 0.1));
}

// A small rim errs, and so do its copies; a large one says where the plane is.
TEST(Candidates, CopiesSettleInTheLevelsThatLargeStrokesTell) {
  Sketch s;
  add_circle({0.5, 0.5, 0}, 0.5, &s);
  add_circle({0.5, 0.5, 0.2}, 0.5, &s);
  add_circle({0.2, 0.3, 0.2 + 0.7 * kTolerance}, 0.01, &s);
  const std::vector<Levels> levels = find_levels(s, kTolerance);
  for (Candidate c : level_copies(s, levels)) {
    settle(levels, kTolerance, &c);
    const double z = c.curve.p[0].z();
    EXPECT_LT(std::min(std::abs(z), std::abs(z - 0.2)), 0.02 * kTolerance);
  }
  Candidate elsewhere{StrokeKind::kCircle, control_points(s, 0)};
  elsewhere.curve.p[0].z() = 0.1;
  settle(levels, kTolerance, &elsewhere);
  EXPECT_EQ(elsewhere.curve.p[0].z(), 0.1);
}

// The plate, and three holes of which edgels tell: one in its top, one 0.1 below, one that two
// views see.
TEST(Candidates, RingsAreWhereThreeViewsAgreeInALevelOrTwoIfAsked) {
  const auto rim = [](const Vector3d& c) {
    return test::circle(c, 0.03 * Vector3d::UnitX(), 0.03 * Vector3d::UnitY());
  };
  const Vector3d in_top(0.6, 0.6, 0.2), below(0.8, 0.2, 0.1), seldom(0.2, 0.7, 0.2);
  const std::vector<View> views = test::ring_of_views(12, {0.5, 0.5, 0.1}, 2.5);
  EdgeWorld world = test::ideal_world(views, {rim(in_top), rim(below)});
  world.footprint = 0.005;
  const EdgeWorld more = test::ideal_world(views, {rim(seldom), rim(in_top), rim(below)});
  for (const size_t v : {size_t(0), size_t(1)}) world.maps[v] = more.maps[v];
  const std::vector<Levels> levels = find_levels(plate(), kTolerance);
  const std::vector<Candidate> rings = level_rings({levels[0]}, world, no_edgels(world), 3);
  ASSERT_EQ(rings.size(), 1);
  EXPECT_EQ(rings[0].kind, StrokeKind::kCircle);
  EXPECT_LT((rings[0].curve.p[0] - in_top).norm(), 0.1 * world.footprint);
  EXPECT_NEAR(rings[0].curve.p[1].norm(), 0.03, 0.1 * world.footprint);
  const std::vector<Candidate> more_rings = level_rings({levels[0]}, world, no_edgels(world), 2);
  const auto has = [&](const Vector3d& centre) {
    return std::any_of(more_rings.begin(), more_rings.end(), [&](const Candidate& c) {
      return (c.curve.p[0] - centre).norm() < 0.1 * world.footprint;
    });
  };
  EXPECT_TRUE(has(in_top));
  EXPECT_TRUE(has(seldom));
  EdgelFlags explained = no_edgels(world);
  for (std::vector<char>& view : explained) std::fill(view.begin(), view.end(), 1);
  EXPECT_TRUE(level_rings({levels[0]}, world, explained, 3).empty());
}

// As on a natural surface, where every stroke is a level of its own.
TEST(Candidates, CopiesIntoOtherLevelsAreLinearInTheNumberOfStrokes) {
  Sketch s = plate();
  constexpr int kScattered = 60;
  for (int k = 0; k < kScattered; ++k) add_circle({0.5, 0.5, -1 - 0.1 * k}, 0.05, &s);
  Levels levels = find_levels(s, kTolerance).front();
  ASSERT_EQ(int(levels.height.size()), kScattered + 2);
  const std::vector<Candidate> copies = level_copies(s, {levels});
  EXPECT_LE(int(copies.size()), 8 * s.size());
  EXPECT_TRUE(has_circle(copies, {0.2, 0.3, 0}, 0.1));  // these levels hold the most strokes
}

TEST(Candidates, AHoleIsMirroredInTheMiddleOfThePart) {
  Sketch s = plate();
  // Two lines upright, so that the sides are levels, too.
  s.add_stroke(StrokeKind::kLine, 0, 4, {});
  s.add_stroke(StrokeKind::kLine, 2, 6, {});
  const std::vector<Candidate> copies = mirror_copies(s, find_levels(s, kTolerance));
  EXPECT_TRUE(has_circle(copies, {0.8, 0.3, 0.2}, 0.1));
  EXPECT_TRUE(has_circle(copies, {0.2, 0.7, 0.2}, 0.1));
  EXPECT_TRUE(has_circle(copies, {0.2, 0.3, 0.0}, 0.1));
}

TEST(Candidates, TheFourthHoleOfARectangleAndTheRestOfABoltCircle) {
  Sketch corners;
  for (const Vector3d& c : {Vector3d(0, 0, 0), Vector3d(2, 0, 0), Vector3d(0, 1, 0)})
    add_circle(c, 0.1, &corners);
  EXPECT_TRUE(has_circle(circle_patterns(corners, kTolerance), {2, 1, 0}, 0.1));

  Sketch bolts;
  add_circle({0, 0, 0.5}, 0.4, &bolts);  // on another level
  for (const double a : {0.0, M_PI / 3}) add_circle({std::cos(a), std::sin(a), 0}, 0.1, &bolts);
  const std::vector<Candidate> copies = circle_patterns(bolts, kTolerance);
  for (int k = 2; k < 6; ++k)
    EXPECT_TRUE(has_circle(copies, {std::cos(k * M_PI / 3), std::sin(k * M_PI / 3), 0}, 0.1)) << k;
}

TEST(Candidates, WithoutAPictureNothingIsAdded) {
  EdgeWorld world;
  world.footprint = 0.005;
  View view;
  view.camera = {400, 400, 500, 500, 199.5, 199.5};
  view.cam_from_world.translation = Vector3d(-0.5, -0.5, 3);
  world.views = {view};
  world.maps.resize(1);
  world.plane_normal.resize(1);
  const MissingEdges missing = add_missing(plate(), world, {});
  EXPECT_GT(missing.candidates, 0);
  EXPECT_TRUE(missing.nats.empty());
  EXPECT_EQ(missing.sketch.size(), plate().size());
}

}  // namespace
}  // namespace sketchsplat
