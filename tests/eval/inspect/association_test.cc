// SPDX-License-Identifier: MIT
#include "eval/inspect/association.h"

#include <gtest/gtest.h>

#include "tests/eval/inspect/plate.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;

Nominal nominal_plate() { return make_nominal(plate(), "plate"); }

TEST(Nominal, TwoHalvesOfACircleAreOneEdgeAndLinesThatGoOnToo) {
  Sketch s;
  const int a = s.add_node({-2, 0, 0}), b = s.add_node({2, 0, 0}), c = s.add_node({0, 10, 0}),
            d = s.add_node({5, 10, 0}), e = s.add_node({9, 10, 0}), f = s.add_node({9, 12, 0});
  s.add_stroke(StrokeKind::kArc, a, b, {{0, 2, 0}});
  s.add_stroke(StrokeKind::kArc, b, a, {{0, -2, 0}});
  s.add_stroke(StrokeKind::kLine, c, d, {});
  s.add_stroke(StrokeKind::kLine, d, e, {});
  s.add_stroke(StrokeKind::kLine, e, f, {});
  const Nominal nominal = make_nominal(s, "part");
  ASSERT_EQ(nominal.edges.size(), 3u);
  EXPECT_EQ(nominal.edges[0].kind, StrokeKind::kCircle);
  EXPECT_EQ(nominal.edges[1].strokes, (std::vector<int>{2, 3}));
  EXPECT_NEAR(nominal.edges[1].length, 9, 1e-9);
  NominalCircle circle;
  ASSERT_TRUE(circle_of(nominal, 0, &circle));
  EXPECT_NEAR(circle.radius, 2, 1e-9);
  EXPECT_NEAR(circle.angle, 2 * M_PI, 1e-9);
  EXPECT_FALSE(circle_of(nominal, 1, &circle));
}

TEST(Nominal, ThePlanesOfABoxAreSixAndKnowTheirEdges) {
  const Nominal nominal = nominal_plate();
  EXPECT_EQ(nominal.planes.size(), 6u);
  int with_holes = 0;
  for (const NominalPlane& p : nominal.planes) with_holes += p.edges.size() == 4 + 3;
  EXPECT_EQ(with_holes, 2);
}

TEST(Associate, AMovedPartIsFoundAndItsDeviationsAreKnown) {
  const Nominal nominal = nominal_plate();
  const Association a =
      associate(moved(plate(), {1, Eigen::Matrix3d::Identity(), {0, 0, 0.3}}), nominal, {});
  EXPECT_TRUE(a.extras.empty());
  for (size_t e = 0; e < a.edges.size(); ++e) {
    EXPECT_EQ(a.edges[e].presence, Presence::kFound) << e;
    EXPECT_EQ(a.edges[e].strokes, std::vector<int>{int(e)});
    const bool upright = e >= 8 && e < 12;
    for (const EdgePlace& p : a.edges[e].places)
      if (p.stroke >= 0) {
        EXPECT_NEAR(p.deviation.norm(), upright ? 0 : 0.3, 1e-9) << e;
      }
  }
}

TEST(Associate, AnEdgeMayBeMissingOrThereInParts) {
  Sketch part = plate();
  std::vector<bool> keep(part.size(), true);
  keep[0] = keep[12] = false;
  part = keep_strokes(part, keep);
  const int a = part.add_node({10, 0, 0}), b = part.add_node({50, 0, 0});
  part.add_stroke(StrokeKind::kLine, a, b, {});
  const Association found = associate(part, nominal_plate(), {});
  EXPECT_EQ(found.edges[0].presence, Presence::kPartly);
  EXPECT_NEAR(found.edges[0].found, 0.4, 0.03);
  EXPECT_EQ(found.edges[12].presence, Presence::kMissing);
  EXPECT_EQ(found.edges[1].presence, Presence::kFound);
}

TEST(Associate, AnEdgeInPiecesIsFound) {
  Sketch part = plate();
  std::vector<bool> keep(part.size(), true);
  keep[0] = false;
  part = keep_strokes(part, keep);
  const int a = part.add_node({0, 0, 0}), b = part.add_node({48, 0, 0});
  const int c = part.add_node({50, 0, 0}), d = part.add_node({100, 0, 0});
  part.add_stroke(StrokeKind::kLine, a, b, {});
  part.add_stroke(StrokeKind::kLine, c, d, {});
  const Association found = associate(part, nominal_plate(), {});
  EXPECT_EQ(found.edges[0].presence, Presence::kFound);
  EXPECT_EQ(found.edges[0].strokes.size(), 2u);
}

TEST(Associate, WhatTheViewsCannotSeeIsNotMissed) {
  const Nominal nominal = nominal_plate();
  std::vector<bool> keep(size_t(nominal.sketch.size()), true);
  keep[0] = keep[1] = false;
  const Sketch part = keep_strokes(plate(), keep);
  std::vector<std::vector<int>> seen_by;
  for (const auto& places : nominal_places(nominal, 0.01)) seen_by.emplace_back(places.size(), 9);
  for (int& views : seen_by[0]) views = 2;
  const Association a = associate(part, nominal, {}, seen_by);
  EXPECT_EQ(a.edges[0].presence, Presence::kNotVisible);
  EXPECT_EQ(a.edges[1].presence, Presence::kMissing);
}

TEST(Associate, CurvesThatNominalHasNotAreNamed) {
  Sketch part = plate();
  part.add_stroke(StrokeKind::kCircle, -1, -1, {{50, 30, 10}, {0, 0, 3}});
  const Association a = associate(part, nominal_plate(), {});
  ASSERT_EQ(a.extras.size(), 1u);
  EXPECT_EQ(a.extras[0].stroke, part.size() - 1);
  EXPECT_NEAR(a.extras[0].length, 6 * M_PI, 1e-6);
}

}  // namespace
}  // namespace sketchsplat
