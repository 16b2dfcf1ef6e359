// SPDX-License-Identifier: MIT
#include "pipelines/join/splice.h"

#include <gtest/gtest.h>

#include "sketches/curve/closest.h"
#include "tests/support/strokes.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;
const Vector3d kMiddle(0.5, 0.5, 0.5);

// A slender S.
Sketch wave() {
  Sketch s;
  add_bezier(&s, {0.2, 0.4, 0.5}, {0.4, 0.7, 0.5}, {0.6, 0.3, 0.5}, {0.8, 0.6, 0.5});
  return s;
}

class Splice : public testing::Test {
 protected:
  Splice() : world(ideal_world(ring_of_views(12, kMiddle, 3), polylines_of(wave()))) {}
  // The part of the wave between two parameters.
  static void add_piece(Sketch* s, double t0, double t1) {
    const ControlPoints c = subcurve(StrokeKind::kBezier, control_points(wave(), 0), t0, t1);
    add_bezier(s, c.p[0], c.p[1], c.p[2], c.p[3]);
  }
  Spliced spliced(const Sketch& s) const {
    const Spliced out = splice(s, world, {}, {});
    EXPECT_TRUE(validate(out.sketch).empty());
    return out;
  }
  double from_wave(const Sketch& s) const {
    double worst = 0;
    for (int i = 0; i < s.size(); ++i)
      for (double t = 0; t <= 1; t += 0.05)
        worst = std::max(worst, distance_to_stroke(wave(), 0, point_at(s, i, t)).distance);
    return worst / px();
  }
  double px() const { return world.footprint; }
  const EdgeWorld world;
};

TEST_F(Splice, PiecesThatOverlapMeetInTheMiddleOfIt) {
  Sketch s;
  add_piece(&s, 0, 0.6);
  add_piece(&s, 0.4, 1);
  const Spliced out = spliced(s);
  EXPECT_EQ(out.overlaps, 1);
  ASSERT_EQ(out.sketch.size(), 2);
  ASSERT_EQ(out.sketch.nodes.cols(), 3);
  EXPECT_EQ(out.sketch.strokes[0].end, out.sketch.strokes[1].begin);
  EXPECT_LT((point_at(out.sketch, 0, 1) - point_at(wave(), 0, 0.5)).norm(), px());
  EXPECT_LT(from_wave(out.sketch), 0.01);
}

TEST_F(Splice, WhicheverWayThePiecesRun) {
  Sketch s;
  const ControlPoints c = subcurve(StrokeKind::kBezier, control_points(wave(), 0), 0.4, 1);
  add_bezier(&s, c.p[3], c.p[2], c.p[1], c.p[0]);
  add_piece(&s, 0, 0.6);
  const Spliced out = spliced(s);
  EXPECT_EQ(out.overlaps, 1);
  EXPECT_EQ(out.sketch.strokes[0].end, out.sketch.strokes[1].end);
  EXPECT_LT(from_wave(out.sketch), 0.01);
}

TEST_F(Splice, ACubicGoesOverAGapInWhichAnEdgeIsSeen) {
  Sketch s;
  add_piece(&s, 0, 0.5);
  add_piece(&s, 0.55, 1);
  const double gap = (point_at(s, 0, 1) - point_at(s, 1, 0)).norm();
  ASSERT_GT(gap, 4 * px());
  ASSERT_LT(gap, 12 * px());
  const Spliced out = spliced(s);
  EXPECT_EQ(out.gaps, 1);
  ASSERT_EQ(out.sketch.size(), 3);
  EXPECT_EQ(out.sketch.nodes.cols(), 4);
  EXPECT_LT(from_wave(out.sketch), 0.1);
}

TEST_F(Splice, NothingGoesOverAGapInWhichNoneIs) {
  Sketch s;
  add_piece(&s, 0, 0.4);
  add_piece(&s, 0.6, 1);
  const Spliced out =
      splice(s, ideal_world(ring_of_views(12, kMiddle, 3), polylines_of(s)), {}, {});
  EXPECT_EQ(out.gaps + out.overlaps, 0);
  EXPECT_EQ(out.sketch.size(), 2);
}

// On the lid of a cube, in pictures with masks; all of it, or without its middle.
EdgeWorld lid(bool whole) {
  const std::vector<View> views = ring_of_views(40, kMiddle, 3);
  const std::vector<Vector3d> corners = cube_corners({0.1, 0.1, -0.1}, 0.8);
  std::vector<Polyline> seen = polylines_of(wave());
  if (!whole)
    seen = {Polyline(seen[0].begin(), seen[0].begin() + 150),
            Polyline(seen[0].begin() + 250, seen[0].end())};
  for (Polyline& p : seen)
    for (Vector3d& x : p) x.z() = 0.7;
  std::vector<EdgelMap> maps;
  for (const View& v : views) {
    maps.push_back(ideal_edgels(v, seen));
    maps.back().mask = convex_mask(v, corners);
  }
  return make_edge_world(views, maps);
}

TEST_F(Splice, AWideGapIsBridgedWhereViewsSeeAnEdge) {
  Sketch s;
  add_piece(&s, 0, 0.4);
  add_piece(&s, 0.6, 1);
  s.nodes.row(2).setConstant(0.7), s.handles.row(2).setConstant(0.7);
  const Spliced out = splice(s, lid(true), {}, {});
  EXPECT_EQ(out.gaps, 1);
  EXPECT_EQ(out.sketch.size(), 3);
  EXPECT_EQ(splice(s, lid(false), {}, {}).gaps, 0);
}

TEST_F(Splice, DuplicatesStrokesBesideAndCornersAreLeftAlone) {
  Sketch s;
  add_piece(&s, 0, 1);
  add_piece(&s, 0.05, 0.98);  // a duplicate: more of it is shared than not
  const Vector3d aside(0, 0, 3 * px());
  const ControlPoints c = control_points(wave(), 0);
  add_bezier(&s, c.p[0] + aside, c.p[1] + aside, c.p[2] + aside, c.p[3] + aside);
  add_line(&s, {0.8, 0.6, 0.5}, {0.9, 0.2, 0.5});  // turns
  const Spliced out = spliced(s);
  EXPECT_EQ(out.gaps + out.overlaps, 0);
  EXPECT_EQ(out.sketch.size(), 4);
}

TEST_F(Splice, AnEndThatOthersHoldStays) {
  Sketch s;
  add_piece(&s, 0, 0.6);
  add_piece(&s, 0.4, 1);
  s.add_stroke(StrokeKind::kLine, s.strokes[0].end, s.add_node({0.5, 0.5, 0.9}), {});
  EXPECT_EQ(spliced(s).overlaps, 0);
}

TEST_F(Splice, NothingFromNothing) { EXPECT_EQ(spliced({}).sketch.size(), 0); }

}  // namespace
}  // namespace sketchsplat
