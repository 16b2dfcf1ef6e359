// SPDX-License-Identifier: MIT
#include "pipelines/survey/gap.h"

#include <gtest/gtest.h>

#include "sketches/curve/curve.h"
#include "sketches/fit/segment.h"
#include "tests/support/strokes.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;
const Vector3d kMiddle(0.5, 0.5, 0.5);
const Vector3d kBegin(0.25, 0.3, 0.8), kEnd(0.75, 0.42, 0.8);

// The thirds at both ends of the line from kBegin to kEnd; with masks, on the upper face of a cube.
std::vector<Polyline> curves(bool cube) {
  std::vector<Polyline> out;
  if (cube) out = cube_edges({0.2, 0.2, 0.2}, 0.6);
  out.push_back(segment(kBegin, kBegin + (kEnd - kBegin) / 3));
  out.push_back(segment(kEnd - (kEnd - kBegin) / 3, kEnd));
  return out;
}

EdgeWorld world_of(bool masks) {
  const std::vector<View> views = ring_of_views(16, kMiddle, 3);
  std::vector<EdgelMap> maps;
  for (const View& view : views) {
    maps.push_back(ideal_edgels(view, curves(masks)));
    if (masks) maps.back().mask = convex_mask(view, cube_corners({0.2, 0.2, 0.2}, 0.6));
  }
  return make_edge_world(views, maps);
}

double cost(const EdgeWorld& world, double t0, double t1, const Vector3d& aside = {0, 0, 0}) {
  Sketch s;
  add_line(&s, kBegin + aside, kEnd + aside);
  const double length = (t1 - t0) * (kEnd - kBegin).norm();
  return gap_cost(StrokeKind::kLine, control_points(s, 0), t0, t1, length, world, {});
}

double places(const EdgeWorld& world, double share) {
  return share * (kEnd - kBegin).norm() / (2 * world.footprint);
}

TEST(Gap, WhereViewsSeeAnEdgeItPaysToSaySo) {
  for (const bool masks : {false, true}) EXPECT_LT(cost(world_of(masks), 0.05, 0.3), -5) << masks;
}

TEST(Gap, WhereViewsThatMustSeeOneSeeNoneItCosts) {
  for (const bool masks : {false, true}) EXPECT_GT(cost(world_of(masks), 0.4, 0.6), 1) << masks;
}

// A place that no view shows an edge at, of n that must: n log((1 - rate) / (1 - chance)).
TEST(Gap, IsTheSumOverPlacesAndViewsAtTheRateOfWhatIsKnown) {
  Sketch s;
  add_line(&s, kBegin, kEnd);
  const auto unseen = [&](bool masks, double seen_rate, double found_rate) {
    const EdgeWorld world = world_of(masks);
    GapOptions options;
    options.seen_rate = seen_rate, options.found_rate = found_rate;
    const double length = 0.2 * (kEnd - kBegin).norm();
    return gap_cost(StrokeKind::kLine, control_points(s, 0), 0.4, 0.6, length, world, options) /
           (places(world, 0.2));
  };
  for (const bool masks : {false, true}) {
    const double a = unseen(masks, 0.05, 0.05), b = unseen(masks, 0.05, 0.06),
                 c = unseen(masks, 0.06, 0.05);
    EXPECT_EQ(a == b, masks) << "without masks nobody knows what may hide it";
    EXPECT_EQ(a == c, !masks);
    const double more = masks ? c : b;
    EXPECT_NEAR(more / a, std::log(0.94 / 0.97) / std::log(0.95 / 0.97), 0.05);
  }
  EXPECT_NEAR(unseen(false, 0.05, 0.05), -16 * std::log(0.95 / 0.97), 0.1) << "of sixteen views";
}

TEST(Gap, LongerGapsCostMore) {
  const EdgeWorld world = world_of(false);
  EXPECT_NEAR(cost(world, 0.4, 0.6), 2 * cost(world, 0.4, 0.5), 4);
}

TEST(Gap, InsideTheHullNoViewMustSeeAnything) {
  EXPECT_EQ(cost(world_of(true), 0.2, 0.8, {0, 0.2, -0.3}), 0);
}

TEST(Gap, NoPlaceSaysMoreThanAnOutlierCosts) {
  const EdgeWorld world = world_of(false);
  EXPECT_GE(cost(world, 0, 1.0 / 3), -kOutlierNats * (places(world, 1.0 / 3) + 1));
  GapOptions sure;
  sure.found_rate = 0.999;
  Sketch s;
  add_line(&s, kBegin, kEnd);
  const double length = 0.2 * (kEnd - kBegin).norm();
  const double most =
      gap_cost(StrokeKind::kLine, control_points(s, 0), 0.4, 0.6, length, world, sure);
  EXPECT_LE(most, kOutlierNats * (places(world, 0.2) + 1));
  EXPECT_GT(most, 0.8 * kOutlierNats * places(world, 0.2));
}

}  // namespace
}  // namespace sketchsplat
