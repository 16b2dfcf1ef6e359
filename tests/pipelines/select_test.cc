// SPDX-License-Identifier: MIT
#include "pipelines/survey/select.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "pipelines/options/derived_options.h"
#include "tests/support/strokes.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;
const Vector3d kMiddle(0.5, 0.5, 0.5);
constexpr double kPixel = 3.0 / 500;

Sketch cube() {
  Sketch s;
  for (const Polyline& e : cube_edges({0.2, 0.2, 0.2}, 0.6)) add_line(&s, e[0], e[1]);
  return s;
}

// A world in which view v sees curves(v).
template <typename Curves>
EdgeWorld world_of(int views, const Curves& curves) {
  const std::vector<View> v = ring_of_views(views, kMiddle, 3);
  std::vector<EdgelMap> maps;
  for (int i = 0; i < views; ++i) maps.push_back(ideal_edgels(v[i], curves(i, v[i])));
  return make_edge_world(v, maps);
}

TEST(Select, TrueEdgesAreKept) {
  const EdgeWorld w = ideal_world(ring_of_views(20, kMiddle, 3), polylines_of(cube()));
  const Selection s = select_strokes(cube(), w, {});
  ASSERT_EQ(s.verdicts.size(), 12u);
  EXPECT_EQ(s.sketch.size(), 12);
  EXPECT_EQ(s.changes, 0);
  for (int i = 0; i < 12; ++i) {
    EXPECT_EQ(s.verdicts[i], Verdict::kKept);
    EXPECT_EQ(s.remap.stroke[i], i);
    EXPECT_GT(s.stats[i].cover, 0.9);
    EXPECT_LT(s.stats[i].rms_px, 0.1);
    EXPECT_GT(s.nats[i], 10);
  }
}

TEST(Select, WhatIsSurelyNoRoundIsNoMoreAnEdgeForIt) {
  constexpr double kSure = 1000;
  for (const double nats : {-5.0, -0.5, 0.5, 30.0}) {
    EXPECT_NEAR(edge_nats(nats, kSure, 0.5), nats, 1e-9);
    EXPECT_LT(edge_nats(nats, 0, 0.5), nats);
  }
  EXPECT_GT(edge_nats(kSure, 0, 0.5), 0) << "where nothing tells whether it is a round";
  EXPECT_LT(edge_nats(kSure, -1, 0.5), 0);
  EXPECT_GT(edge_nats(kSure, -1, 0.05), 0) << "where rounds are rare";
}

TEST(Select, TheContourOfASphereIsNoEdgeWhateverCircleStandsForIt) {
  Sketch s = cube();
  for (const Vector3d& axis : {Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(0.6, 0, 0.8)})
    add_circle(&s, kMiddle, 0.25 * axis);
  const EdgeWorld w = world_of(60, [](int, const View& v) {
    std::vector<Polyline> seen = polylines_of(cube());
    // The circle in which the sphere is touched by rays from the camera.
    const Vector3d to_camera = v.center_in_world() - kMiddle, back = to_camera.normalized();
    const double r = 0.25, near = r * r / to_camera.norm(), rim = std::sqrt(r * r - near * near);
    const Vector3d right = v.cam_from_world.rotation.row(0);
    const Vector3d x = (right - right.dot(back) * back).normalized();
    seen.push_back(circle(kMiddle + near * back, rim * x, rim * back.cross(x)));
    return seen;
  });
  const Selection out = select_strokes(s, w, {});
  EXPECT_EQ(out.sketch.size(), 12);
  for (int i = 12; i < 15; ++i) EXPECT_NE(out.verdicts[i], Verdict::kKept);
}

TEST(Select, TheContourOfACylinderIsNoEdgeButItsRimsAre) {
  constexpr double kRadius = 0.25;
  Sketch s;
  add_circle(&s, {0.5, 0.5, 0.2}, {0, 0, kRadius});
  add_circle(&s, {0.5, 0.5, 0.8}, {0, 0, kRadius});
  for (int k = 0; k < 8; ++k) {
    const Vector3d side(kRadius * std::cos(k * 0.8), kRadius * std::sin(k * 0.8), 0);
    add_line(&s, Vector3d(0.5, 0.5, 0.2) + side, Vector3d(0.5, 0.5, 0.8) + side);
  }
  const EdgeWorld w = world_of(60, [&](int, const View& v) {
    std::vector<Polyline> seen = {polyline_of(s, 0), polyline_of(s, 1)};
    const Vector3d c = v.center_in_world() - kMiddle;
    const double away = std::hypot(c.x(), c.y());
    if (away <= 1.05 * kRadius) return seen;
    for (int sign : {-1, 1}) {
      const double a = std::atan2(c.y(), c.x()) + sign * std::acos(kRadius / away);
      const Vector3d side(kRadius * std::cos(a), kRadius * std::sin(a), 0);
      seen.push_back(segment(Vector3d(0.5, 0.5, 0.2) + side, Vector3d(0.5, 0.5, 0.8) + side));
    }
    return seen;
  });
  const Selection out = select_strokes(s, w, {});
  EXPECT_EQ(out.verdicts[0], Verdict::kKept);
  EXPECT_EQ(out.verdicts[1], Verdict::kKept);
  EXPECT_EQ(out.sketch.size(), 2);
}

TEST(Select, OfTwoStrokesOnOneEdgeOneIsKept) {
  Sketch s = cube();
  add_line(&s, {0.2, 0.2 + 0.3 * kPixel, 0.2}, {0.8, 0.2, 0.2});  // all of an edge, again
  add_line(&s, {0.3, 0.2, 0.2 - 0.2 * kPixel}, {0.5, 0.2, 0.2});  // a part of it
  const EdgeWorld w = ideal_world(ring_of_views(20, kMiddle, 3), polylines_of(cube()));
  const Selection out = select_strokes(s, w, {});
  EXPECT_EQ(out.sketch.size(), 12);
  EXPECT_EQ(out.changes, 2);
  EXPECT_EQ(out.verdicts[13], Verdict::kRedundant);
  int redundant = 0;
  for (Verdict v : out.verdicts) redundant += v == Verdict::kRedundant;
  EXPECT_EQ(redundant, 2);
  int next = 0;  // those that stay keep their order
  for (int i = 0; i < s.size(); ++i)
    EXPECT_EQ(out.remap.stroke[i], out.verdicts[i] == Verdict::kKept ? next++ : -1);
}

TEST(Select, AnEdgeThatStandsOffInSingleViewsIsLikelierIfItsDetectorErrsSo) {
  // Every view sees one edge of the cube a third of a pixel off, to one side or the other.
  const Vector3d off(0, 0, kPixel / 3);
  const EdgeWorld w = world_of(20, [&](int i, const View&) {
    std::vector<Polyline> seen = polylines_of(cube());
    for (Vector3d& p : seen[0]) p += i / 2 % 2 ? off : -off;
    return seen;
  });
  const auto nats = [&w](const char* detector, int stroke) {
    ReconstructOptions options;
    options.detector = detector;
    options.select.round.least_radius_px = 1e6;  // what tells of rounds is another matter
    return select_strokes(cube(), w, select_options(options)).nats[stroke];
  };
  EXPECT_GT(nats("2dgs-sn", 0), nats("image", 0) + 3);
  EXPECT_LT(nats("2dgs-sn", 5), nats("image", 5)) << "one that stands still is less sure then";
}

TEST(Select, OddsOfEdgesAreThoseUnderWhichTheLikelihoodRatiosWereDrawn) {
  EXPECT_NEAR(odds_of_edge({}), 1, 1e-9);
  EXPECT_NEAR(odds_of_edge(std::vector<double>(99, 50)), 20, 1e-3);
  EXPECT_LT(odds_of_edge(std::vector<double>(12, 50)), 3) << "few strokes say little";
  EXPECT_NEAR(odds_of_edge(std::vector<double>(9, -50)), 1, 1e-3) << "never less";
  EXPECT_NEAR(odds_of_edge(std::vector<double>(9, -50), true), 1 / 14.0, 1e-3)
      << "but of rare ones";
  // Of normal likelihood ratios: mean half the variance.
  std::mt19937 rng(3);
  std::normal_distribution<double> normal(0, 3);
  for (const int edges : {300, 380}) {
    std::vector<double> nats;
    for (int i = 0; i < 400; ++i) nats.push_back(normal(rng) + (i < edges ? 4.5 : -4.5));
    EXPECT_NEAR(std::log(odds_of_edge(nats)), std::log(edges / (400.0 - edges)), 0.4);
  }
}

TEST(Select, WhatIsUnlikelyByItselfMayStayWhereNoStrokeIsAnAccident) {
  Sketch s = cube();
  const int rare = add_line(&s, {0.3, 0.5, 0.4}, {0.7, 0.6, 0.6});
  const EdgeWorld w = world_of(40, [&](int i, const View&) {
    std::vector<Polyline> seen = polylines_of(cube());
    if (i % 6 == 0) seen.push_back(polyline_of(s, rare));
    return seen;
  });
  SelectOptions options;
  options.round.least_radius_px = 1e6;
  options.edge_odds = 1;
  const Selection alone = select_strokes(s, w, options);
  options.least_nats = alone.nats[rare] + 1;
  EXPECT_EQ(select_strokes(s, w, options).verdicts[rare], Verdict::kUnlikely);
  options.edge_odds = 0;
  const Selection all = select_strokes(s, w, options);
  EXPECT_EQ(all.verdicts[rare], Verdict::kKept);
  EXPECT_GT(all.edge_odds, 2);
  EXPECT_NEAR(all.nats[rare], alone.nats[rare] + std::log(all.edge_odds), 1e-6);
}

// A cube, of which every second view shows the strokes beyond its edges, `seeing` views in all.
EdgeWorld with_rare_lines(int views, int seeing, const Sketch& s) {
  return world_of(views, [&](int i, const View&) {
    std::vector<Polyline> seen = polylines_of(cube());
    for (int k = int(seen.size()); k < s.size() && i % 2 == 0 && i / 2 < seeing; ++k)
      seen.push_back(polyline_of(s, k));
    return seen;
  });
}

TEST(Select, AStrokeThatTooFewViewsSeeIsNotKept) {
  const SelectOptions options;
  Sketch s = cube();
  const int rare = add_line(&s, {0.3, 0.5, 0.4}, {0.7, 0.6, 0.6});
  for (int seeing : {options.min_views - 1, options.min_views + 4}) {
    const EdgeWorld w = with_rare_lines(20, seeing, s);
    const Verdict verdict = select_strokes(s, w, options).verdicts[rare];
    EXPECT_EQ(verdict == Verdict::kKept, seeing >= options.min_views) << seeing << " views";
  }
}

TEST(Select, ThreeViewsOfSixShowEdgesAndThreeOfManyDoNot) {
  Sketch s = cube();
  for (const double y : {0.3, 0.5, 0.7}) add_line(&s, {0.3, y, 0.4}, {0.7, y + 0.1, 0.6});
  for (const int views : {6, 40}) {
    const Selection out = select_strokes(s, with_rare_lines(views, 3, s), {});
    for (int i = 12; i < s.size(); ++i)
      EXPECT_EQ(out.verdicts[i] == Verdict::kKept, views == 6)
          << i << " of " << views << " views, " << out.nats[i] << " nat";
  }
}

TEST(Select, OfThreeViewsThatShowALineTwoMakeItAndItsOddsAreThoseOfRareOnes) {
  Sketch s = cube();
  const int rare = add_line(&s, {0.3, 0.5, 0.4}, {0.7, 0.6, 0.6});
  const EdgeWorld w = with_rare_lines(8, 3, s);
  SelectOptions options;
  options.round.least_radius_px = 1e6;  // what tells of rounds is another matter
  options.edge_odds = 1;
  options.sure_views = 3;
  const Selection sure = select_strokes(s, w, options);
  options.sure_views = 4;
  const Selection few = select_strokes(s, w, options);
  ASSERT_GT(sure.nats[rare], 0);
  EXPECT_NEAR(few.nats[rare], sure.nats[rare] / 3 + std::log(few.rare_odds), 1e-6);
  EXPECT_LT(few.rare_odds, 1) << "one stroke alone says little";
  EXPECT_EQ(few.nats[0], sure.nats[0]);
}

TEST(Select, AStrokeStaysIfWhatItAloneExplainsIsWorthItsParameters) {
  // Most of the second lies on the first; 6 or 60 px go beyond it.
  for (const auto& [beyond_px, kept] : {std::pair(6, false), std::pair(60, true)}) {
    Sketch s;
    const Vector3d end(0.6 + beyond_px * kPixel, 0.5, 0.5);
    add_line(&s, {0.1, 0.5, 0.5}, {0.6, 0.5, 0.5});
    add_line(&s, {0.2, 0.5, 0.5}, end);
    const EdgeWorld w = ideal_world(ring_of_views(20, kMiddle, 3), {{{0.1, 0.5, 0.5}, end}});
    std::vector<Verdict> verdicts = select_strokes(s, w, {}).verdicts;
    std::sort(verdicts.begin(), verdicts.end());
    EXPECT_EQ(verdicts.front(), Verdict::kKept);
    EXPECT_EQ(verdicts.back(), kept ? Verdict::kKept : Verdict::kRedundant) << beyond_px;
  }
}

TEST(Select, ParallelEdgesFourPixelsApartAreTwo) {
  Sketch s;
  const Vector3d gap(0, 2.8 * kPixel, 2.8 * kPixel);
  add_line(&s, {0.1, 0.5, 0.5}, {0.9, 0.5, 0.5});
  add_line(&s, Vector3d(0.1, 0.5, 0.5) + gap, Vector3d(0.9, 0.5, 0.5) + gap);
  const EdgeWorld w = ideal_world(ring_of_views(20, kMiddle, 3), polylines_of(s));
  EXPECT_EQ(select_strokes(s, w, {}).sketch.size(), 2);
}

// [px] between the middle line along x and the same moved by `gap`, in a view.
double pixels_apart(const View& v, const Vector3d& gap) {
  double z;
  const Eigen::Vector2d p = v.project(kMiddle, &z),
                        q = v.project(kMiddle + 0.1 * Vector3d::UnitX(), &z);
  const Eigen::Vector2d d = v.project(kMiddle + gap, &z) - p, along = (q - p).normalized();
  return std::abs(d.x() * along.y() - d.y() * along.x());
}

TEST(Select, AnEdgeStaysThoughManyViewsSeeAnotherOneInItsPlace) {
  Sketch s;
  const Vector3d gap(0, 0, 3 * kPixel);
  add_line(&s, {0.1, 0.5, 0.5}, {0.9, 0.5, 0.5});
  add_line(&s, Vector3d(0.1, 0.5, 0.5) + gap, Vector3d(0.9, 0.5, 0.5) + gap);
  // Where they lie less than 1.5 px apart there is one edge in the picture: the first.
  int apart = 0;
  const EdgeWorld w = world_of(60, [&](int, const View& v) {
    std::vector<Polyline> seen = {polyline_of(s, 0)};
    if (pixels_apart(v, gap) < 1.5) return seen;
    seen.push_back(polyline_of(s, 1));
    ++apart;
    return seen;
  });
  ASSERT_GT(apart, 20);
  ASSERT_LT(apart, 50);
  EXPECT_EQ(select_strokes(s, w, {}).sketch.size(), 2);
}

TEST(Select, AnEdgeThatFewViewsSeeStaysThoughOthersLieInItsPlaceWhereItIsHidden) {
  // Four pixels beside an edge that all see: fifteen views see it, many see the other near it.
  Sketch s;
  const Vector3d gap(0, 0, 4 * kPixel);
  add_line(&s, {0.1, 0.5, 0.5}, {0.9, 0.5, 0.5});
  const int rare = add_line(&s, Vector3d(0.3, 0.5, 0.5) + gap, Vector3d(0.7, 0.5, 0.5) + gap);
  for (int seeing : {0, 15}) {
    int shown = 0;
    const EdgeWorld w = world_of(60, [&](int, const View& v) {
      std::vector<Polyline> seen = {polyline_of(s, 0)};
      if (pixels_apart(v, gap) > 2.5 && shown < seeing)
        seen.push_back(polyline_of(s, rare)), ++shown;
      return seen;
    });
    ASSERT_EQ(shown, seeing);
    const Verdict verdict = select_strokes(s, w, {}).verdicts[rare];
    EXPECT_EQ(verdict == Verdict::kKept, seeing > 0) << verdict_name(verdict);
  }
}

TEST(Select, SaysWhyAStrokeFalls) {
  Sketch s = cube();
  const int tiny = add_line(&s, {0.2, 0.2, 0.3}, {0.2, 0.2, 0.3 + 2 * kPixel});
  const int soft = add_line(&s, {0.3, 0.5, 0.4}, {0.7, 0.5, 0.45});
  const int nowhere = add_line(&s, {40, 40, 40}, {41, 40, 40});
  const std::vector<View> views = ring_of_views(20, kMiddle, 3);
  std::vector<EdgelMap> maps;
  for (const View& v : views) {
    std::vector<Polyline> seen = polylines_of(cube());
    const size_t sharp = ideal_edgels(v, seen).edgels.size();
    seen.push_back(polyline_of(s, soft));
    maps.push_back(ideal_edgels(v, seen));
    std::vector<Edgel>& e = maps.back().edgels;
    for (size_t i = sharp; i < e.size(); ++i) e[i].width = 3;
  }
  const Selection out = select_strokes(s, make_edge_world(views, maps), {});
  EXPECT_EQ(out.verdicts[tiny], Verdict::kShort);
  EXPECT_EQ(out.verdicts[soft], Verdict::kUnlikely);
  EXPECT_EQ(out.verdicts[nowhere], Verdict::kUnlikely);
  EXPECT_EQ(out.sketch.size(), 12);
  EXPECT_STREQ(verdict_name(Verdict::kShort), "short");
  EXPECT_STREQ(verdict_name(Verdict::kRedundant), "redundant");
}

// A mark in the middle of a face that every n-th of the views that look at this face sees.
struct Marked {
  Sketch sketch = cube();
  int mark = add_line(&sketch, {0.35, 0.45, 0.8}, {0.65, 0.55, 0.8});
  EdgeWorld world;
  Marked(int num_views, int every) {
    const std::vector<View> views = ring_of_views(num_views, kMiddle, 3);
    std::vector<EdgelMap> maps;
    for (const View& v : views) {
      std::vector<Polyline> seen = polylines_of(cube());
      const bool in_front = v.center_in_world().z() > 1.2;
      if (in_front && maps.size() % every == 0) seen.push_back(polyline_of(sketch, mark));
      maps.push_back(ideal_edgels(v, seen));
      maps.back().mask = convex_mask(v, cube_corners({0.2, 0.2, 0.2}, 0.6));
    }
    world = make_edge_world(views, maps);
  }
};

TEST(Select, WhatAFewViewsSeeAndManyMustSeeIsNoEdge) {
  for (int every : {1, 6}) {
    const Marked m(70, every);
    const Selection out = select_strokes(m.sketch, m.world, {});
    EXPECT_EQ(out.verdicts[m.mark], every == 1 ? Verdict::kKept : Verdict::kUnlikely);
    EXPECT_EQ(out.sketch.size(), every == 1 ? 13 : 12);
  }
}

TEST(Select, OfNothingIsNothing) {
  const EdgeWorld w = ideal_world(ring_of_views(8, kMiddle, 3), polylines_of(cube()));
  const Selection none = select_strokes(Sketch(), w, {});
  EXPECT_EQ(none.sketch.size(), 0);
  EXPECT_EQ(none.changes, 0);
  const std::vector<View> views = ring_of_views(5, kMiddle, 3);
  const EdgeWorld blank = make_edge_world(views, std::vector<EdgelMap>(5));
  EXPECT_EQ(select_strokes(cube(), blank, {}).sketch.size(), 0);
}

}  // namespace
}  // namespace sketchsplat
