// SPDX-License-Identifier: MIT
#include "eval/metrics/structure.h"

#include <gtest/gtest.h>

#include <cmath>

#include "eval/metrics/metrics.h"

namespace sketchsplat {
namespace {

Eigen::Matrix3Xd segment(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  Eigen::Matrix3Xd p(3, 2);
  p << a, b;
  return p;
}

Eigen::Matrix3Xd arc(double from_deg, double to_deg, int pieces) {
  Eigen::Matrix3Xd p(3, pieces + 1);
  for (int i = 0; i <= pieces; ++i) {
    const double a = (from_deg + (to_deg - from_deg) * i / pieces) * M_PI / 180;
    p.col(i) << 0.3 * std::cos(a), 0.3 * std::sin(a), 0;
  }
  return p;
}

TEST(MergeSmooth, JoinsTwoHalvesOfACircleWhicheverWayTheyRun) {
  const auto both = merge_smooth({{"circle", arc(0, 180, 36)}, {"circle", arc(180, 360, 36)}});
  ASSERT_EQ(both.size(), 1u);
  EXPECT_EQ(both[0].polyline.cols(), 73);
  EXPECT_EQ(merge_smooth({{"circle", arc(180, 0, 36)}, {"circle", arc(180, 360, 36)}}).size(), 1u);
}

TEST(MergeSmooth, KeepsArcsOfTwoCirclesThatRunIntoOneAnother) {
  Eigen::Matrix3Xd other = 0.5 * arc(180, 270, 36);
  other.row(0).array() -= 0.15;
  ASSERT_LT((other.col(0) - arc(0, 180, 36).rightCols<1>()).norm(), 1e-9);
  EXPECT_EQ(merge_smooth({{"arc", arc(0, 180, 36)}, {"arc", other}}).size(), 2u);
  EXPECT_EQ(merge_smooth({{"bspline", arc(0, 180, 36)}, {"bspline", other}}).size(), 1u);
}

TEST(MergeSmooth, JoinsPiecesOfALine) {
  const auto joined = merge_smooth({{"line", segment({0, 0, 0}, {0.4, 0, 0})},
                                    {"line", segment({1, 0, 0}, {0.7, 0, 0})},
                                    {"line", segment({0.4, 0, 0}, {0.7, 0, 0})}});
  ASSERT_EQ(joined.size(), 1u);
  EXPECT_NEAR((joined[0].polyline.col(0) - joined[0].polyline.rightCols<1>()).norm(), 1, 1e-12);
}

TEST(MergeSmooth, KeepsAVertexWhereAnotherEdgeEnds) {
  EXPECT_EQ(merge_smooth({{"line", segment({0, 0, 0}, {0.5, 0, 0})},
                          {"line", segment({0.5, 0, 0}, {1, 0, 0})},
                          {"line", segment({0.5, 0, 0}, {0.5, 1, 0})}})
                .size(),
            3u);
}

TEST(MergeSmooth, KeepsCornersOtherTypesAndGaps) {
  const auto line = segment({0, 0, 0}, {0.5, 0, 0});
  const double a = 5 * M_PI / 180;
  const auto bent = segment({0.5, 0, 0}, {0.5 + 0.5 * std::cos(a), 0.5 * std::sin(a), 0});
  EXPECT_EQ(merge_smooth({{"line", line}, {"line", bent}}).size(), 2u) << "5 degrees";
  EXPECT_EQ(merge_smooth({{"bspline", line}, {"bspline", bent}}).size(), 1u) << "5 of 12 degrees";
  const auto straight = segment({0.5, 0, 0}, {1, 0, 0});
  EXPECT_EQ(merge_smooth({{"line", line}, {"circle", straight}}).size(), 2u);
  const auto apart = segment({0.503, 0, 0}, {1, 0, 0});
  EXPECT_EQ(merge_smooth({{"line", line}, {"line", apart}}).size(), 2u);
}

TEST(MergeSmooth, BearsNothingAndOnePoint) {
  EXPECT_TRUE(merge_smooth({}).empty());
  const Eigen::Matrix3Xd point = Eigen::Matrix3Xd::Zero(3, 1);
  EXPECT_EQ(merge_smooth({{"line", point}, {"line", point}}).size(), 2u);
}

TEST(MatchStrokes, PairsEachEdgeOnce) {
  const auto x = segment({0, 0, 0}, {1, 0, 0}), y = segment({0, 0, 0}, {0, 1, 0});
  const auto stroke = densify(x, 0.005);
  const Structure s = match_strokes({stroke, stroke}, {{"line", x}, {"line", y}});
  EXPECT_EQ(s.matched, 1) << "a duplicate finds its edge taken";
  EXPECT_NEAR(s.f, 50, 1e-12);
}

TEST(MatchStrokes, AsksForMostOfTheStrokeAndMostOfTheEdge) {
  const std::vector<TrueEdge> edge = {{"line", segment({0, 0, 0}, {1, 0, 0})}};
  const auto matched = [&](double to) {
    return match_strokes({densify(segment({0, 0, 0}, {to, 0, 0}), 0.001)}, edge).matched;
  };
  EXPECT_EQ(matched(0.80), 0);
  EXPECT_EQ(matched(0.87), 1);
  EXPECT_EQ(matched(1.15), 1);
  EXPECT_EQ(matched(1.25), 0);
  EXPECT_EQ(match_strokes({densify(segment({0, 0.006, 0}, {1, 0.006, 0}), 0.001)}, edge).matched,
            0);
  EXPECT_EQ(match_strokes({densify(segment({0, 0.004, 0}, {1, 0.004, 0}), 0.001)}, edge).matched,
            1);
}

TEST(MatchStrokes, OfNothingIsZero) {
  EXPECT_EQ(match_strokes({}, {}).f, 0);
  EXPECT_EQ(match_strokes({}, {{"line", segment({0, 0, 0}, {1, 0, 0})}}).f, 0);
  EXPECT_EQ(match_strokes({Eigen::Matrix3Xd(3, 0)}, {{"line", segment({0, 0, 0}, {1, 0, 0})}}).f,
            0);
}

}  // namespace
}  // namespace sketchsplat
