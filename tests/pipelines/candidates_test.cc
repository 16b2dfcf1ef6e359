// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>

#include "pipelines/candidates/add_missing.h"
#include "pipelines/candidates/generators.h"
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
TEST(Candidates, RingsAreWhereViewsAgreeInALevel) {
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
  std::vector<LevelRing> rings = level_rings({levels[0]}, world, no_edgels(world), 100);
  ASSERT_GE(rings.size(), 2);
  const auto by_views = [](const LevelRing& a, const LevelRing& b) { return a.views > b.views; };
  std::stable_sort(rings.begin(), rings.end(), by_views);
  EXPECT_GE(rings[0].views, 3);
  EXPECT_EQ(rings[0].ring.kind, StrokeKind::kCircle);
  EXPECT_LT((rings[0].ring.curve.p[0] - in_top).norm(), 0.1 * world.footprint);
  EXPECT_NEAR(rings[0].ring.curve.p[1].norm(), 0.03, 0.1 * world.footprint);
  EXPECT_LE(rings[1].views, 2);  // none of the one below, on which views do not agree here
  const auto of_two = [&](const LevelRing& r) {
    return r.views == 2 && (r.ring.curve.p[0] - seldom).norm() < 0.1 * world.footprint;
  };
  EXPECT_EQ(std::count_if(rings.begin(), rings.end(), of_two), 1);
  EdgelFlags explained = no_edgels(world);
  for (std::vector<char>& view : explained) std::fill(view.begin(), view.end(), 1);
  EXPECT_TRUE(level_rings({levels[0]}, world, explained, 100).empty());
  const auto of_at_most = [&](size_t most) {
    return level_rings({levels[0]}, world, no_edgels(world), most).size();
  };
  EXPECT_EQ(of_at_most(rings.size()), rings.size());
  EXPECT_EQ(of_at_most(rings.size() - 1), 0u);
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

LevelRing ring(double angle, double distance, double radius) {
  LevelRing out;
  out.views = 1;
  out.ring.kind = StrokeKind::kCircle;
  out.ring.curve.count = 2;
  out.ring.curve.p[0] = {distance * std::cos(angle), distance * std::sin(angle), 0.2};
  out.ring.curve.p[1] = radius * Vector3d::UnitZ();
  return out;
}

std::vector<Candidate> patterns_of(const Sketch& sketch, const std::vector<LevelRing>& rings) {
  EdgeWorld world;
  world.footprint = 0.005;
  const ContrastJudge judge(world, {}, {}, {});
  int tried = 0;
  const std::vector<Candidate> out =
      ring_patterns(sketch, rings, kTolerance, world, judge, 7, &tried);
  EXPECT_EQ(tried, out.empty() ? 0 : 1);
  return out;
}

// Of six holes around a bore four are seen, one of them in the sketch; a ring elsewhere, one of
// another size and one at another distance are none of them.
TEST(Candidates, HalfOfABoltCircleAsksForAllOfItAsOneGroup) {
  Sketch bore;
  add_circle({0, 0, 0.5}, 0.3, &bore);  // of another level
  add_circle({std::cos(0.1), std::sin(0.1), 0.2}, 0.1, &bore);
  const double turn = M_PI / 3;
  const std::vector<LevelRing> strays = {ring(1.5, 1, 0.1), ring(0.1 + 4 * turn, 1, 0.13),
                                         ring(0.1 + 5 * turn, 1.1, 0.1)};
  std::vector<LevelRing> rings = strays;
  for (const int k : {1, 2, 3}) rings.push_back(ring(0.1 + k * turn, 1, 0.1));
  const std::vector<Candidate> pattern = patterns_of(bore, rings);
  ASSERT_EQ(pattern.size(), 6);
  for (int k = 0; k < 6; ++k) {
    const Vector3d centre(std::cos(0.1 + k * turn), std::sin(0.1 + k * turn), 0.2);
    EXPECT_TRUE(has_circle(pattern, centre, 0.1)) << k;
    EXPECT_EQ(pattern[k].group, 7);
  }
  rings = strays;
  rings.push_back(ring(0.1 + turn, 1, 0.1));
  EXPECT_TRUE(patterns_of(bore, rings).empty());  // of six, two
}

TEST(Candidates, RingsThatDoNotRepeatOrHaveNothingToGoAroundAreNoPattern) {
  Sketch bore;
  add_circle({0, 0, 0.5}, 0.3, &bore);
  EXPECT_TRUE(patterns_of(bore, {ring(0, 1, 0.1), ring(0.9, 1, 0.1), ring(2.2, 1, 0.1)}).empty());
  std::vector<LevelRing> whole;
  for (int k = 0; k < 4; ++k) whole.push_back(ring(k * M_PI / 2, 1, 0.1));
  EXPECT_EQ(patterns_of(bore, whole).size(), 4);
  EXPECT_TRUE(patterns_of({}, whole).empty());
  for (LevelRing& r : whole) r.ring.curve.p[1] = Vector3d(0, 0.1, 0);  // upright
  EXPECT_TRUE(patterns_of(bore, whole).empty());
}

// A prism with a bore. `without`: of its upright edges, the first of them.
Sketch prism(int sides, int without) {
  Sketch s;
  std::vector<int> low, high;
  for (int k = 0; k < sides; ++k) {
    const double a = 0.3 + 2 * M_PI * k / sides;
    low.push_back(s.add_node({std::cos(a), std::sin(a), 0}));
    high.push_back(s.add_node({std::cos(a), std::sin(a), 0.6}));
  }
  for (int k = 0; k < sides; ++k) {
    const int next = (k + 1) % sides;
    s.add_stroke(StrokeKind::kLine, low[k], low[next], {});
    s.add_stroke(StrokeKind::kLine, high[k], high[next], {});
    if (k >= without) s.add_stroke(StrokeKind::kLine, low[k], high[k], {});
  }
  add_circle({0, 0, 0}, 0.4, &s);
  add_circle({0, 0, 0.6}, 0.4, &s);
  return s;
}

std::vector<Candidate> symmetric_of(const Sketch& s) {
  constexpr double kPx = 0.005;
  const KnownCurves known(s, kPx, kKnownPx * kPx);
  int tried = 0;
  const std::vector<Candidate> out =
      symmetry_copies(s, find_levels(s, kTolerance), known, kTolerance, kPx, 3, &tried);
  EXPECT_EQ(tried == 0, out.empty());
  for (const Candidate& c : out) EXPECT_TRUE(c.group >= 3 && c.group < 3 + tried);
  return out;
}

int uprights(const std::vector<Candidate>& candidates) {
  int out = 0;
  for (const Candidate& c : candidates)
    out += c.kind == StrokeKind::kLine && std::abs(c.curve.p[0].z() - c.curve.p[1].z()) > 0.59;
  return out;
}

TEST(Candidates, TheEdgesThatANutLacksAreThoseThatItsSymmetryAsksFor) {
  const std::vector<Candidate> missing = symmetric_of(prism(6, 2));
  EXPECT_EQ(missing.size(), 6);  // the known four among them
  EXPECT_EQ(uprights(missing), 6);
  EXPECT_TRUE(symmetric_of(prism(6, 0)).empty());
  EXPECT_TRUE(symmetric_of(prism(6, 5)).empty());  // one of six tells nothing
  EXPECT_TRUE(symmetric_of({}).empty());
}

TEST(Candidates, PiecesOfACircleInASymmetricPartAreACircle) {
  Sketch s = prism(6, 0);
  const auto at = [](double a) { return Vector3d(0.7 * std::cos(a), 0.7 * std::sin(a), 0.6); };
  for (const double a : {0.2, 2.0})  // two pieces of 1.3 rad
    s.add_stroke(StrokeKind::kArc, s.add_node(at(a)), s.add_node(at(a + 1.3)), {at(a + 0.65)});
  const std::vector<Candidate> missing = symmetric_of(s);
  EXPECT_TRUE(has_circle(missing, {0, 0, 0.6}, 0.7));
  for (const Candidate& c : missing) EXPECT_EQ(c.kind, StrokeKind::kCircle);
}

// Four lines all over the place, and a circle between them.
TEST(Candidates, WhatIsNotSymmetricAsksForNothing) {
  Sketch s;
  const std::vector<Vector3d> corners = {{0, 0, 0}, {2, 0, 0.3}, {1.7, 1.1, 0}, {0.4, 0.8, 0.5}};
  std::vector<int> nodes;
  for (const Vector3d& c : corners) nodes.push_back(s.add_node(c));
  for (int k = 0; k < 4; ++k) s.add_stroke(StrokeKind::kLine, nodes[k], nodes[(k + 1) % 4], {});
  add_circle({0.9, 0.5, 0.2}, 0.2, &s);
  EXPECT_TRUE(symmetric_of(s).empty());
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
