// SPDX-License-Identifier: MIT
#include "sketches/curve/curve_chain.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "sketches/curve/curve.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

// Three cubics that go on smoothly, the middle one stored backwards, and a line at their end.
struct Wave {
  Sketch sketch;
  int node[5];
  explicit Wave(double turn_deg = 0) {
    const Vector3d p[4] = {{0, 0, 0}, {2, 0, 0}, {5, 1, 0}, {6, 3, 1}};
    Vector3d t[4] = {{1, 1, 0}, {2, -1, 0.5}, {1, 1, 1}, {0, 1, 0}};
    for (int i = 0; i < 4; ++i) node[i] = sketch.add_node(p[i]);
    node[4] = sketch.add_node({6, 3, 4});
    const double length[4] = {0.5, 0.8, 1.1, 0.4};
    const Eigen::AngleAxisd turn(turn_deg * M_PI / 180,
                                 Vector3d(0.5, 1, 0).cross(t[1]).normalized());
    const Vector3d before = p[1] - 0.3 * t[1].normalized();
    sketch.add_stroke(StrokeKind::kBezier, node[0], node[1], {p[0] + length[0] * t[0], before});
    sketch.add_stroke(StrokeKind::kBezier, node[2], node[1],
                      {p[2] - length[2] * t[2], p[1] + turn * (length[1] * t[1])});
    sketch.add_stroke(StrokeKind::kBezier, node[2], node[3],
                      {p[2] + 0.7 * t[2], p[3] - length[3] * t[3]});
    sketch.add_stroke(StrokeKind::kLine, node[3], node[4], {});
  }
};

TEST(CurveChain, SmoothCubicsAreOneCurveWhicheverWayTheyRun) {
  const Wave wave;
  const std::vector<CurveChain> chains = curve_chains(wave.sketch);
  ASSERT_EQ(chains.size(), 2u);
  EXPECT_EQ(chains[0].strokes, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(chains[0].reversed, (std::vector<bool>{false, true, false}));
  EXPECT_EQ(chains[0].begin, wave.node[0]);
  EXPECT_EQ(chains[0].end, wave.node[3]);
  EXPECT_EQ(chains[1].strokes, (std::vector<int>{3}));
}

TEST(CurveChain, StartsWithTheFirstStrokeInTheMiddle) {
  Wave wave;
  std::swap(wave.sketch.strokes[0], wave.sketch.strokes[1]);
  const std::vector<CurveChain> chains = curve_chains(wave.sketch);
  ASSERT_EQ(chains[0].strokes, (std::vector<int>{2, 0, 1}));  // along the first stroke
  EXPECT_EQ(chains[0].reversed, (std::vector<bool>{true, false, true}));
  EXPECT_EQ(chains[0].begin, wave.node[3]);
  EXPECT_EQ(chains[0].end, wave.node[0]);
  const Eigen::Matrix3Xd p = chain_points(wave.sketch, chains[0]);
  EXPECT_EQ(p.col(0), wave.sketch.nodes.col(wave.node[3]));
  EXPECT_EQ(p.col(3), wave.sketch.nodes.col(wave.node[2]));
  EXPECT_EQ(p.col(9), wave.sketch.nodes.col(wave.node[0]));
}

TEST(CurveChain, ACornerOrAThirdStrokeOrAWishEndsIt) {
  EXPECT_EQ(curve_chains(Wave(1).sketch).size(), 3u);
  Wave wave;
  EXPECT_EQ(curve_chains(wave.sketch, {false, true, false, false}).size(), 4u);
  const int other = wave.sketch.add_node({2, 5, 0});
  wave.sketch.add_stroke(StrokeKind::kLine, wave.node[1], other, {});
  EXPECT_EQ(curve_chains(wave.sketch).size(), 4u);
}

TEST(CurveChain, AClosedSplineIsOneCurveFromANodeToItself) {
  Sketch sketch;
  const int a = sketch.add_node({0, 0, 0}), b = sketch.add_node({2, 0, 0});
  sketch.add_stroke(StrokeKind::kBezier, a, b, {Vector3d(0, 1, 0), Vector3d(2, 2, 0)});
  sketch.add_stroke(StrokeKind::kBezier, b, a, {Vector3d(2, -1, 0), Vector3d(0, -3, 0)});
  const std::vector<CurveChain> chains = curve_chains(sketch);
  ASSERT_EQ(chains.size(), 1u);
  EXPECT_EQ(chains[0].strokes.size(), 2u);
  EXPECT_EQ(chains[0].begin, chains[0].end);
}

TEST(CurveChain, ALoopOfOneCubicAndACircleAreCurvesOfTheirOwn) {
  Sketch sketch;
  const int a = sketch.add_node({0, 0, 0});
  sketch.add_stroke(StrokeKind::kBezier, a, a, {Vector3d(1, 1, 0), Vector3d(-1, -1, 0)});
  sketch.add_stroke(StrokeKind::kCircle, -1, -1, {Vector3d(5, 0, 0), Vector3d(0, 0, 1)});
  const std::vector<CurveChain> chains = curve_chains(sketch);
  ASSERT_EQ(chains.size(), 2u);
  EXPECT_EQ(chains[1].begin, -1);
}

TEST(CurveChain, NearlySmoothJointsBecomeSmoothAndCornersStay) {
  Wave near(2), far(5);
  const Sketch before = near.sketch, corner = far.sketch;
  smooth_joints(&near.sketch);
  smooth_joints(&far.sketch);
  EXPECT_EQ(curve_chains(near.sketch).size(), 2u);
  EXPECT_EQ(far.sketch.handles, corner.handles);
  for (int h : {1, 3}) {  // beside the joint: no longer, no shorter
    const Vector3d p = near.sketch.nodes.col(near.node[1]);
    EXPECT_NEAR((near.sketch.handles.col(h) - p).norm(), (before.handles.col(h) - p).norm(), 1e-12);
    EXPECT_GT((near.sketch.handles.col(h) - before.handles.col(h)).norm(), 1e-4);
  }
  EXPECT_EQ(near.sketch.handles.col(0), before.handles.col(0));
}

// de Boor's algorithm on the double knots against de Casteljau's on the spans.
TEST(CurveChain, DoubleKnotsAndTheHandlesAloneGiveTheSameCurve) {
  const Wave wave;
  const CurveChain chain = curve_chains(wave.sketch)[0];
  const Eigen::Matrix3Xd p = chain_points(wave.sketch, chain);
  const std::vector<double> h = span_intervals(p);
  ASSERT_EQ(h.size(), 3u);
  for (int j = 1; j < 3; ++j) {
    const Vector3d joint =
        (h[j] * p.col(3 * j - 1) + h[j - 1] * p.col(3 * j + 1)) / (h[j] + h[j - 1]);
    EXPECT_NEAR((joint - p.col(3 * j)).norm(), 0, 1e-12);
    const Vector3d left = (p.col(3 * j) - p.col(3 * j - 1)) / h[j - 1];
    const Vector3d right = (p.col(3 * j + 1) - p.col(3 * j)) / h[j];
    EXPECT_NEAR((left - right).norm(), 0, 1e-12);
  }
}

TEST(CurveChain, SamplesRunFromBeginToEndWithoutDoubles) {
  const Wave wave;
  const CurveChain chain = curve_chains(wave.sketch)[0];
  const Eigen::Matrix3Xd p = sample_chain(wave.sketch, chain, 0.05);
  EXPECT_EQ(p.col(0), wave.sketch.nodes.col(wave.node[0]));
  EXPECT_NEAR((p.rightCols<1>() - wave.sketch.nodes.col(wave.node[3])).norm(), 0, 1e-12);
  double length = 0;
  for (int i = 1; i < p.cols(); ++i) {
    const double step = (p.col(i) - p.col(i - 1)).norm();
    EXPECT_GT(step, 1e-6);
    EXPECT_LT(step, 0.06);
    length += step;
  }
  double sum = 0;
  for (int s : chain.strokes) sum += stroke_length(wave.sketch, s);
  EXPECT_NEAR(length, sum, 1e-2);
}

TEST(CurveChain, EvidenceIsThatOfItsWeakestSpan) {
  Wave wave;
  for (int s = 0; s < 3; ++s) {
    Evidence& e = wave.sketch.evidence[s];
    e.support_views = 9 - s, e.sigma = 0.1 * s, e.confidence = 0.9 - 0.1 * s, e.opacity = 0.5;
    e.rms_px = 0.2;
  }
  const CurveChain chain = curve_chains(wave.sketch)[0];
  Evidence e = chain_evidence(wave.sketch, chain);
  EXPECT_EQ(e.support_views, 7);
  EXPECT_DOUBLE_EQ(e.sigma, 0.2);
  EXPECT_DOUBLE_EQ(e.confidence, 0.7);
  EXPECT_NEAR(e.opacity, 0.5, 1e-12);
  EXPECT_NEAR(e.rms_px, 0.2, 1e-12);
  wave.sketch.evidence[1].confidence = std::nan("");
  EXPECT_TRUE(std::isnan(chain_evidence(wave.sketch, chain).confidence));
}

}  // namespace
}  // namespace sketchsplat
