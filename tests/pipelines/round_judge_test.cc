// SPDX-License-Identifier: MIT
#include "pipelines/survey/round_judge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "pipelines/survey/select.h"
#include "tests/pipelines/rounded_cube.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector2d;
using Eigen::Vector3d;
TEST(RoundJudge, ASightingIsTheMedianPlaceAndWidthOfItsEdgels) {
  RoundedCube s(0);
  Sketch aside = s.sketch;
  const Vector3d shift(0, 0.4 * kPixel, -0.3 * kPixel);
  for (int n : {aside.strokes[s.rounded].begin, aside.strokes[s.rounded].end})
    aside.nodes.col(n) += shift;
  const Observation there = observe_rounds(s.sketch, s.world, 0);
  const Observation here = observe_rounds(aside, s.world, 0);
  const auto before = round_sightings(s.world, there, s.rounded, nullptr);
  const auto after = round_sightings(s.world, here, s.rounded, nullptr);
  ASSERT_EQ(before.size(), 40u);
  ASSERT_EQ(after.size(), 40u);
  double largest = 0;
  for (size_t v = 0; v < before.size(); ++v) {
    EXPECT_NEAR(before[v].place_px, 0, 0.02);
    EXPECT_NEAR(before[v].log_width, std::log(kSharp), 1e-5);
    // It lies as far beside the moved stroke as the row says, but for the frame's choice of axes.
    EXPECT_LE(std::abs(after[v].place_px), 1.3 * after[v].row.head<2>().norm() * 0.5 + 0.02);
    largest = std::max(largest, std::abs(after[v].place_px));
  }
  EXPECT_GT(largest, 0.4);
}

// A cube one edge of which is cut off: two edges side by side, of which the stroke is one, or which
// it runs between.
struct CutEdge {
  Sketch sketch;
  EdgeWorld world;
  explicit CutEdge(double width_px, double across = 0) {
    const double cut = width_px * kPixel / std::sqrt(2.0);
    const Vector2d a(0.8 - cut, 0.8), b(0.8, 0.8 - cut);
    const auto edge = [](const Vector2d& at) {
      return segment({0.2, at.x(), at.y()}, {0.8, at.x(), at.y()});
    };
    const Polyline stroke = edge(a + across * (b - a));
    add_line(&sketch, stroke[0], stroke[1]);
    std::vector<Polyline> shown = {edge(a), edge(b)};
    for (const Polyline& e :
         cube_edges({0.2, 0.2, 0.2}, 0.6)) {  // they tell how exactly strokes lie
      if (e[0].tail<2>().minCoeff() > 0.7 && e[1].tail<2>().minCoeff() > 0.7) continue;
      add_line(&sketch, e[0], e[1]);
      shown.push_back(e);
    }
    std::vector<EdgelMap> maps;
    const std::vector<View> views = ring_of_views(40, kMiddle, 3);
    for (const View& view : views) {
      // The outline runs along the one from which the line of sight passes the other by.
      const Vector3d c = view.center_in_world();
      const Vector2d camera(c.y(), c.z()), along = b - a, to = a - camera;
      const bool faces = along.x() * to.y() - along.y() * to.x() < 0;
      EdgelMap map = ideal_edgels(view, shown);
      turn_to_middle(view, &map);
      for (Edgel& e : map.edgels) e.width = kSharp;
      const bool outline = (c.y() > 0.8) != (c.z() > 0.8);
      const size_t half = map.chain[1], both = map.chain[2];
      for (size_t i = 0; i < both; ++i)
        map.edgels[i].outline = outline && (i < half) == ((c.y() > 0.8) == faces);
      maps.push_back(map);
    }
    world = make_edge_world(views, maps);
  }
};

TEST(RoundJudge, OutlinesAreFoundBesideAStrokeAndStandOffAsTheRowSays) {
  RoundedCube s(0);
  for (EdgelMap& map : s.world.maps)
    for (Edgel& e : map.edgels) e.outline = true;
  Sketch aside = s.sketch;
  const Vector3d shift(0, 4 * kPixel, -3 * kPixel);
  for (int n : {aside.strokes[s.rounded].begin, aside.strokes[s.rounded].end})
    aside.nodes.col(n) += shift;
  const Observation o = observe_rounds(aside, s.world, 0);
  const int first = o.layout.first[s.rounded], n = o.layout.first[s.rounded + 1] - first;
  const CurvePoints curve{
      o.samples.position.middleCols(first, n), o.samples.tangent.middleCols(first, n), {0, n}};
  const Vector3d u = curve.tangent.col(0).unitOrthogonal(), w = curve.tangent.col(0).cross(u);
  const Vector2d moved = Vector2d(shift.dot(u), shift.dot(w)) / s.world.footprint;
  const Outlines outlines = outlines_beside(s.world, curve, 12);
  EXPECT_EQ(outlines.pieces, 1);
  ASSERT_GT(outlines.seen.size(), 30u);
  double farthest = 0;
  size_t there = 0;  // in a few views another edge of the cube is nearer
  for (const RoundSighting& v : outlines.seen) {
    const double expected = -v.row.head<2>().dot(moved);
    there += std::abs(v.place_px - expected) < 0.1 * std::abs(expected) + 0.1;
    farthest = std::max(farthest, std::abs(v.place_px));
  }
  EXPECT_GE(there + 2, outlines.seen.size());
  EXPECT_GT(farthest, 4);
  EXPECT_LT(outlines_beside(s.world, curve, 2).seen.size(), outlines.seen.size());
}

TEST(RoundJudge, OutlinesFarBesideAStrokeTellARoundFromEdgesSideBySide) {
  for (const double radius : {5, 7, 10, 15}) {
    RoundedCube s(
        radius);  // the stroke lies where the round begins, as the views from one side have it
    for (int n : {s.sketch.strokes[s.rounded].begin, s.sketch.strokes[s.rounded].end})
      s.sketch.nodes.col(n).tail<2>() = Vector2d(0.8 - radius * kPixel, 0.8);
    EXPECT_GT(s.nats(), 5) << radius;
  }
  for (const double width : {3, 5, 8, 14}) {
    const CutEdge s(width);
    const Observation wide = observe_rounds(s.sketch, s.world, 0);
    EXPECT_LT(RoundJudge(s.world, wide, {}).nats(0, nullptr), 0) << width;
  }
}

TEST(RoundJudge, ANarrowCutIsNoRoundThoughItsStrokeRunsBetweenTheTwoEdges) {
  RoundModel outlines_alone;
  outlines_alone.accident = 1;  // what lies near a stroke tells nothing
  for (const double width : {1.5, 2.0, 3.0})
    for (const double across : {0.25, 0.5, 0.75}) {
      const CutEdge s(width, across);
      const Observation wide = observe_rounds(s.sketch, s.world, 0);
      EXPECT_LT(RoundJudge(s.world, wide, outlines_alone).nats(0, nullptr), 2)
          << width << " " << across;
    }
  const RoundedCube round(8);
  EXPECT_GT(round.nats(outlines_alone), 5);
}

TEST(RoundJudge, EdgelsOfOthersTellNothing) {
  const RoundedCube s(6);
  EdgelFlags all = no_edgels(s.world);
  for (auto& view : all) std::fill(view.begin(), view.end(), 1);
  const Observation wide = observe_rounds(s.sketch, s.world, 0);
  EXPECT_EQ(RoundJudge(s.world, wide, {}).nats(s.rounded, &all), 0);
}

TEST(RoundJudge, ARoundOfSixPixelsIsNoEdgeAndTheSameEdgeSharpIsOne) {
  EXPECT_GT(RoundedCube(6).nats(), 5) << "its outline moves";
  EXPECT_GT(RoundedCube(6, 1.4f).nats(), RoundedCube(6).nats() + 5) << "and its shading is wide";
  EXPECT_LT(RoundedCube(0).nats(), -10);
}

TEST(RoundJudge, ASharpEdgeInBlurredPicturesIsNoRound) {
  EXPECT_LT(RoundedCube(0, 1, 2.5f).nats(), -10);
  EXPECT_GT(RoundedCube(6, 1, 2.5f).nats(), 5);
}

TEST(RoundJudge, TheBlurOfAViewIsItsOwn) {
  RoundedCube s(0);
  for (size_t v = 0; v < s.world.maps.size(); v += 2)  // half of them are out of focus
    for (Edgel& e : s.world.maps[v].edgels) e.width *= 2;
  EXPECT_LT(s.nats(), -20);
  const Observation wide = observe_rounds(s.sketch, s.world, 0);
  const RoundJudge judge(s.world, wide, {});
  EXPECT_NEAR(judge.log_width(0), std::log(2 * kSharp), 1e-3);
  EXPECT_NEAR(judge.log_width(1), std::log(kSharp), 1e-3);
}

TEST(RoundJudge, RoundsBecomeEdgesGraduallyAsTheirRadiusShrinks) {
  double last = INFINITY;
  for (const double radius : {4, 2, 1}) {
    const double nats = RoundedCube(radius).nats();
    EXPECT_LT(nats, last) << radius;
    last = nats;
  }
  EXPECT_LT(last, 0);
}

TEST(RoundJudge, WhatCountsAsRoundIsAnOptionInPixelsAndInUnits) {
  const RoundedCube s(4);
  RoundModel model;
  model.least_radius_px = 1e6;
  EXPECT_EQ(s.nats(model), -INFINITY);
  model.least_radius_px = 2;
  model.least_radius = 1;
  EXPECT_EQ(s.nats(model), -INFINITY);
  model.least_radius = 2 * s.world.footprint;
  EXPECT_DOUBLE_EQ(s.nats(model), s.nats());
}

TEST(RoundJudge, ANarrowEdgeIsLessOfARoundThanAWideOneAndViewsByWidthSayWhy) {
  const RoundedCube same(0), narrow(0, 0.85f), wide(0, 1.09f), wider(0, 1.2f);
  EXPECT_LT(same.nats(), narrow.nats());
  EXPECT_LT(narrow.nats(), wider.nats());
  EXPECT_LT(same.nats(), wide.nats());
  EXPECT_LT(wide.nats(), wider.nats());
  int kind = 0;
  for (const RoundedCube* s : {&narrow, &same, &wide, &wider}) {
    const Observation o = observe_rounds(s->sketch, s->world, 0);
    const std::array<int, 4> views =
        RoundJudge(s->world, o, {}).views_by_width(s->rounded, nullptr);
    EXPECT_GT(views[kind], 10) << kind;
    EXPECT_EQ(std::count(views.begin(), views.end(), 0), 3) << kind;
    ++kind;
  }
}

TEST(RoundJudge, WhereAllOthersAreSharpARoundIsUnlikelyBeforehand) {
  EXPECT_NEAR(odds_of_round({}), 0.5, 1e-9);
  std::vector<double> nats(60, -20);
  EXPECT_LT(odds_of_round(nats), 0.02);
  EXPECT_LT(odds_of_round(nats), odds_of_round(std::vector<double>(6, -20)));
  nats.push_back(4);  // hardly: one that looks like it is less than a round by itself
  EXPECT_LT(std::log(odds_of_round(nats)) + 4, 1);
  nats.insert(nats.end(), 30, 20);
  EXPECT_NEAR(odds_of_round(nats), 0.5, 0.05);
}

TEST(Select, ARoundIsLeftOutAndTheSameEdgeSharpIsKept) {
  EXPECT_EQ(
      select_strokes(RoundedCube(0, 1, 2).sketch, RoundedCube(0, 1, 2).world, {}).sketch.size(),
      12);
  const RoundedCube s(6, 1.3f);
  const Selection chosen = select_strokes(s.sketch, s.world, {});
  EXPECT_EQ(chosen.sketch.size(), 11);
  EXPECT_EQ(chosen.verdicts[s.rounded], Verdict::kRound);
}

}  // namespace
}  // namespace sketchsplat
