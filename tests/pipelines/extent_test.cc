// SPDX-License-Identifier: MIT
#include "pipelines/survey/extent.h"

#include <gtest/gtest.h>

#include "tests/support/strokes.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;
const Vector3d kMiddle(0.5, 0.5, 0.5);
constexpr double kSlack = 2.5;  // [px] a sample still answers to an edgel two pixels back

// The part of a stroke between two parameters, which may lie beyond its ends.
Sketch cut(const Sketch& s, double t0, double t1) {
  Sketch out = s;
  const StrokeKind kind = s.strokes[0].kind;
  const ControlPoints c = subcurve(kind, control_points(s, 0), t0, t1);
  out.nodes.col(s.strokes[0].begin) = c.p[0];
  out.nodes.col(s.strokes[0].end) = c.p[c.count - 1];
  for (int h = 0; h < num_handles(kind); ++h) out.handles.col(s.strokes[0].handle + h) = c.p[1 + h];
  return out;
}

std::vector<Sketch> open_kinds() {
  std::vector<Sketch> out(3);
  add_line(&out[0], {0.2, 0.3, 0.4}, {0.8, 0.35, 0.6});
  add_arc(&out[1], {0.2, 0.3, 0.5}, {0.5, 0.55, 0.6}, {0.8, 0.3, 0.5});
  add_bezier(&out[2], {0.2, 0.3, 0.4}, {0.4, 0.6, 0.5}, {0.6, 0.1, 0.5}, {0.8, 0.5, 0.6});
  return out;
}

class Extent : public testing::TestWithParam<int> {
 protected:
  Extent()
      : truth(open_kinds()[GetParam()]),
        world(ideal_world(ring_of_views(16, kMiddle, 3), polylines_of(truth))) {}
  void expect_true_ends(const Sketch& s) const {
    EXPECT_LT((point_at(s, 0, 0) - point_at(truth, 0, 0)).norm(), kSlack * world.footprint);
    EXPECT_LT((point_at(s, 0, 1) - point_at(truth, 0, 1)).norm(), kSlack * world.footprint);
  }
  const Sketch truth;
  const EdgeWorld world;
};

TEST_P(Extent, AStrokeCutShortGrowsToItsTrueEnds) {
  const double share = 8 * world.footprint / stroke_length(truth, 0);
  const Sketch s = cut(truth, share, 1 - share);
  ASSERT_GT((point_at(s, 0, 0) - point_at(truth, 0, 0)).norm(), 3 * world.footprint);
  expect_true_ends(fit_extents(s, world, {}));
}

TEST_P(Extent, AStrokeThatIsTooLongRetreats) {
  const double share = 10 * world.footprint / stroke_length(truth, 0);
  const Sketch s = cut(truth, -share, 1 + share);
  expect_true_ends(fit_extents(s, world, {}));
}

TEST_P(Extent, AStrokeOfTheRightLengthKeepsIt) { expect_true_ends(fit_extents(truth, world, {})); }

TEST_P(Extent, NoStrokeLeavesTheBox) {
  ExtentOptions options;
  options.box.extend(Vector3d(0.25, 0, 0));
  options.box.extend(Vector3d(0.65, 1, 1));
  const Sketch s = fit_extents(truth, world, options);
  for (const double t : {0.0, 1.0}) {
    EXPECT_GT(point_at(s, 0, t).x(), 0.25 - 1e-9);
    EXPECT_LT(point_at(s, 0, t).x(), 0.65 + 1e-9);
  }
  EXPECT_NEAR(point_at(s, 0, 0).x(), 0.25, kSlack * world.footprint);
  EXPECT_NEAR(point_at(s, 0, 1).x(), 0.65, kSlack * world.footprint);
}

INSTANTIATE_TEST_SUITE_P(Kinds, Extent, testing::Range(0, 3), [](const auto& info) {
  return std::string(kind_name(open_kinds()[info.param].strokes[0].kind));
});

TEST(FitExtents, ClosedStrokesAndSharedNodesStay) {
  Sketch truth;
  add_circle(&truth, {0.5, 0.5, 0.3}, {0, 0, 0.2});
  const int a = truth.add_node({0.2, 0.2, 0.6}), b = truth.add_node({0.8, 0.2, 0.6});
  const int c = truth.add_node({0.8, 0.8, 0.7});
  truth.add_stroke(StrokeKind::kLine, a, b, {});
  truth.add_stroke(StrokeKind::kLine, b, c, {});
  const EdgeWorld w = ideal_world(ring_of_views(16, kMiddle, 3), polylines_of(truth));
  Sketch s = truth;
  const Vector3d corner = truth.nodes.col(b) - 6 * w.footprint * Vector3d::UnitX();
  s.nodes.col(b) = corner;  // too short, but shared
  s.nodes.col(a) += 6 * w.footprint * Vector3d::UnitX();
  const Sketch fitted = fit_extents(s, w, {});
  EXPECT_EQ(fitted.handles, s.handles);
  EXPECT_EQ(Vector3d(fitted.nodes.col(b)), corner);
  EXPECT_LT((fitted.nodes.col(a) - truth.nodes.col(a)).norm(), kSlack * w.footprint);
}

TEST(FitExtents, AnEndDoesNotRunIntoTheEdgelsOfAnotherStroke) {
  // Two pieces of one line with a gap: each may grow into the gap, not over the other.
  Sketch truth;
  add_line(&truth, {0.1, 0.5, 0.5}, {0.45, 0.5, 0.5});
  add_line(&truth, {0.51, 0.5, 0.5}, {0.9, 0.5, 0.5});
  const EdgeWorld w = ideal_world(ring_of_views(16, kMiddle, 3), polylines_of(truth));
  const Sketch fitted = fit_extents(truth, w, {});
  EXPECT_LT(fitted.nodes(0, fitted.strokes[0].end), 0.45 + kSlack * w.footprint);
  EXPECT_GT(fitted.nodes(0, fitted.strokes[1].begin), 0.51 - kSlack * w.footprint);
}

TEST(FitExtents, AGapInsideAStrokeEndsItUnlessEnoughIsSeenBeyond) {
  Sketch s;
  add_line(&s, {0.1, 0.5, 0.5}, {0.9, 0.5, 0.5});
  const auto end = [&s](double seen_again, double gap_price) {
    const EdgeWorld w = ideal_world(ring_of_views(16, kMiddle, 3),
                                    {segment({0.1, 0.5, 0.5}, {0.7, 0.5, 0.5}),
                                     segment({seen_again, 0.5, 0.5}, {0.9, 0.5, 0.5})});
    ExtentOptions options;
    options.gap_price = gap_price;
    const Sketch fitted = fit_extents(s, w, options);
    EXPECT_NEAR(fitted.nodes(0, s.strokes[0].begin), 0.1, kSlack * w.footprint);
    return fitted.nodes(0, s.strokes[0].end);
  };
  constexpr double kOff = 0.015;
  EXPECT_NEAR(end(0.76, 2), 0.9, kOff) << "more than twice as much beyond";
  EXPECT_NEAR(end(0.82, 2), 0.7, kOff) << "two thirds of it";
  EXPECT_NEAR(end(0.76, 0), 0.7, kOff) << "every gap is an end";
}

TEST(FitExtents, WhatNobodySeesAndNothingAtAllStay) {
  Sketch s;
  add_line(&s, {40, 40, 40}, {41, 40, 40});
  add_line(&s, {0.5, 0.5, 0.5}, {0.5, 0.5, 0.5});  // no length
  const EdgeWorld w =
      ideal_world(ring_of_views(8, kMiddle, 3), {segment({0.1, 0.2, 0.2}, {0.9, 0.2, 0.2})});
  EXPECT_EQ(fit_extents(s, w, {}).nodes, s.nodes);
  EXPECT_EQ(fit_extents(Sketch(), w, {}).size(), 0);
}

}  // namespace
}  // namespace sketchsplat
