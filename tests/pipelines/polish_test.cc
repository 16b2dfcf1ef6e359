// SPDX-License-Identifier: MIT
#include "pipelines/adjust/polish.h"

#include <gtest/gtest.h>

#include "tests/support/strokes.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;
const Vector3d kMiddle(0.5, 0.5, 0.5);

// One stroke of each kind, far from one another.
Sketch four_kinds(double unit = 1) {
  Sketch s;
  add_line(&s, {0.1, 0.15, 0.3}, {0.9, 0.1, 0.35});
  add_arc(&s, {0.15, 0.35, 0.8}, {0.45, 0.55, 0.85}, {0.8, 0.4, 0.8});
  add_circle(&s, {0.3, 0.6, 0.3}, {0.03, 0.02, 0.15});
  add_bezier(&s, {0.6, 0.3, 0.1}, {0.7, 0.6, 0.2}, {0.8, 0.5, 0.5}, {0.9, 0.9, 0.6});
  return scaled(s, unit);
}
EdgeWorld world_of(const Sketch& truth, double unit = 1) {
  return ideal_world(ring_of_views(20, unit * kMiddle, 3 * unit), polylines_of(truth));
}

// Every control point goes its own way, about 0.8 px.
Sketch bent(Sketch s, double footprint) {
  for (int i = 0; i < s.nodes.cols(); ++i)
    s.nodes.col(i) += 0.8 * footprint * Vector3d(std::sin(i + 1.), std::cos(3. * i), 0.3);
  for (int i = 0; i < s.handles.cols(); ++i)
    s.handles.col(i) += 0.8 * footprint * Vector3d(std::cos(2. * i), 0.3, std::sin(i + 2.));
  return s;
}

TEST(Polish, BringsEveryKindBackToAFiftiethOfAPixel) {
  const Sketch truth = four_kinds();
  const EdgeWorld w = world_of(truth);
  const Sketch off = bent(truth, w.footprint), back = polish(off, w, {});
  for (int s = 0; s < truth.size(); ++s) {
    EXPECT_GT(farthest(off, s, {polyline_of(truth, s)}, 0.03), 0.3 * w.footprint);
    EXPECT_LT(farthest(back, s, {polyline_of(truth, s)}, 0.03), 0.02 * w.footprint)
        << kind_name(truth.strokes[s].kind);
  }
}

// From a fifth of a pixel: a flat arc's quarter point is a long lever.
TEST(Polish, BringsArcsOfEllipsesBackToo) {
  for (double turn : {2.0, 3.0, 4.5}) {
    Sketch truth;
    add_elliptic_arc(&truth, {0.5, 0.5, 0.5}, {0.35, 0, 0.1}, {0, 0.2, 0.06}, 0.3, 0.3 + turn);
    const EdgeWorld w = world_of(truth);
    const Sketch off = bent(truth, 0.25 * w.footprint), back = polish(off, w, {});
    EXPECT_GT(farthest(off, 0, {polyline_of(truth, 0)}, 0.03), 0.1 * w.footprint);
    EXPECT_LT(farthest(back, 0, {polyline_of(truth, 0)}, 0.03), 0.02 * w.footprint) << turn;
  }
}

TEST(Polish, StrokesThatShareANodeStillDoAndItIsTheTrueCorner) {
  Sketch truth;
  const std::vector<Vector3d> corners = {
      {0.2, 0.2, 0.4}, {0.8, 0.2, 0.4}, {0.8, 0.8, 0.6}, {0.2, 0.8, 0.6}};
  for (const Vector3d& c : corners) truth.add_node(c);
  for (int i = 0; i < 4; ++i) truth.add_stroke(StrokeKind::kLine, i, (i + 1) % 4, {});
  const EdgeWorld w = world_of(truth);
  const Sketch back = polish(bent(truth, w.footprint), w, {});
  ASSERT_EQ(back.nodes.cols(), 4);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(back.strokes[i].begin, i);
    EXPECT_EQ(back.strokes[i].end, (i + 1) % 4);
    EXPECT_LT((back.nodes.col(i) - corners[i]).norm(), 0.02 * w.footprint);
  }
}

TEST(Polish, AStrokeThatNobodySeesStaysWhereItIs) {
  const Sketch truth = four_kinds();
  const EdgeWorld w = world_of(truth);
  Sketch s = bent(truth, w.footprint);
  const int outside = add_line(&s, {40, 40, 40}, {41, 40, 40});
  const Sketch back = polish(s, w, {});
  ASSERT_TRUE(back.nodes.allFinite());
  EXPECT_LT((back.nodes.col(back.strokes[outside].begin) - Vector3d(40, 40, 40)).norm(), 1e-9);
  EXPECT_LT(farthest(back, 0, {polyline_of(truth, 0)}, 0.03), 0.02 * w.footprint);
}

// As beside an outline of a round that leaves an edge, which every fourth view shows.
TEST(Polish, EdgelsOfSomethingElseHalfAPixelBesideDrawAStrokeLessIfItReachesLess) {
  Sketch truth;
  add_line(&truth, {0.1, 0.45, 0.5}, {0.9, 0.55, 0.5});
  EdgeWorld w = world_of(truth);
  std::vector<EdgelMap> maps = w.maps;
  for (size_t v = 0; v < maps.size(); v += 4) {
    for (size_t i = 0; i < maps[v].edgels.size() / 2; ++i) maps[v].edgels[i].y += 0.5f;
    build_lookup(&maps[v], 4.0);
  }
  const EdgeWorld beside = make_edge_world(w.views, maps);
  PolishOptions wide, near;
  near.final_reach_px = 0.3;
  near.final_reach = 3;
  const std::vector<Polyline> line = {polyline_of(truth, 0)};
  const double off = farthest(polish(truth, beside, wide), 0, line, 0.03);
  EXPECT_GT(off, 0.05 * w.footprint);
  EXPECT_LT(farthest(polish(truth, beside, near), 0, line, 0.03), 0.5 * off);
}

TEST(Polish, ScalesWithTheUnitOfTheScene) {
  const EdgeWorld w = world_of(four_kinds());
  const Sketch expected = polish(bent(four_kinds(), w.footprint), w, {});
  for (double unit : {1e-3, 1e3}) {
    const EdgeWorld other = world_of(four_kinds(unit), unit);
    const Sketch s = polish(scaled(bent(four_kinds(), w.footprint), unit), other, {});
    EXPECT_LT((s.nodes / unit - expected.nodes).cwiseAbs().maxCoeff(), 1e-6) << unit;
    EXPECT_LT((s.handles / unit - expected.handles).cwiseAbs().maxCoeff(), 1e-6) << unit;
  }
}

TEST(Polish, NothingStaysNothing) {
  const EdgeWorld w = world_of(four_kinds());
  EXPECT_EQ(polish(Sketch(), w, {}).size(), 0);
  const std::vector<View> views = ring_of_views(5, kMiddle, 3);
  const EdgeWorld blank = make_edge_world(views, std::vector<EdgelMap>(5));
  EXPECT_EQ(polish(four_kinds(), blank, {}).nodes, four_kinds().nodes);
}

TEST(Polish, ParallelEdgesFourPixelsApartDoNotMixTheirEdgels) {
  Sketch truth;
  const Vector3d up(0, 0, 4 * 3.0 / 500);
  add_line(&truth, {0.1, 0.5, 0.5}, {0.9, 0.5, 0.5});
  add_line(&truth, Vector3d(0.1, 0.5, 0.5) + up, Vector3d(0.9, 0.5, 0.5) + up);
  const EdgeWorld w = world_of(truth);
  const Sketch back = polish(moved(truth, 0.15 * up), w, {});
  for (int s = 0; s < 2; ++s)
    EXPECT_LT(farthest(back, s, {polyline_of(truth, s)}, 0.03), 0.05 * w.footprint);
}

}  // namespace
}  // namespace sketchsplat
