// SPDX-License-Identifier: MIT
#include "eval/metrics/metrics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "datasets/truth/ground_truth.h"
#include "datasets/truth/published_samples.h"
#include "eval/metrics/nearest.h"

namespace sketchsplat {
namespace {

Eigen::Matrix3Xd points(std::initializer_list<Eigen::Vector3d> list) {
  Eigen::Matrix3Xd out(3, list.size());
  Eigen::Index i = 0;
  for (const auto& p : list) out.col(i++) = p;
  return out;
}

Prediction one_line(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  Prediction prediction;
  prediction.lines.emplace_back();
  prediction.lines[0] << a, b;
  return prediction;
}

Prediction one_cubic(const Eigen::Matrix<double, 3, 4>& control) {
  Prediction prediction;
  prediction.curves.push_back(control);
  return prediction;
}

// All values from CPython 3.11.
TEST(FloorDivide, IsPythonsNotTheFloorOfTheQuotient) {
  EXPECT_EQ(floor_divide(0.015, 0.005), 2);
  EXPECT_EQ(std::floor(0.015 / 0.005), 3);
  EXPECT_EQ(floor_divide(1.0, 0.1), 9);
  EXPECT_EQ(floor_divide(0.3, 0.1), 2);
  EXPECT_EQ(floor_divide(0.1, 0.005), 20);
  EXPECT_EQ(floor_divide(0.0049999, 0.005), 0);
  EXPECT_EQ(floor_divide(0.005, 0.005), 1);
  EXPECT_EQ(floor_divide(-0.001, 0.005), -1);
  EXPECT_EQ(floor_divide(0.0, 0.005), 0);
}

TEST(SamplePublished, TakesFloorOfLengthSamplesWithBothEnds) {
  const Eigen::Matrix3Xd samples = sample_published(one_line({0, 0, 0}, {0.1, 0, 0}), 0.005);
  ASSERT_EQ(samples.cols(), 20);
  EXPECT_EQ(samples.col(0), Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(samples.col(19), Eigen::Vector3d(0.1, 0, 0));
  EXPECT_NEAR(samples(0, 1), 0.1 / 19, 1e-15);
}

TEST(SamplePublished, DropsWhatIsShorterThanTheStep) {
  EXPECT_EQ(sample_published(one_line({0, 0, 0}, {0.0049, 0, 0}), 0.005).cols(), 0);
  EXPECT_EQ(sample_published(one_line({0, 0, 0}, {0, 0, 0}), 0.005).cols(), 0);
  const Eigen::Matrix3Xd one = sample_published(one_line({1, 2, 3}, {1, 2, 3.007}), 0.005);
  ASSERT_EQ(one.cols(), 1);
  EXPECT_EQ(one.col(0), Eigen::Vector3d(1, 2, 3)) << "the only sample is the first end";
}

TEST(SamplePublished, TakesCubicsUniformInTheParameter) {
  Eigen::Matrix<double, 3, 4> control = Eigen::Matrix<double, 3, 4>::Zero();
  control.row(0) << 0, 0, 0, 0.1;  // x = 0.1 t^3
  const Eigen::Matrix3Xd samples = sample_published(one_cubic(control), 0.0049);
  ASSERT_EQ(samples.cols(), 20);
  EXPECT_NEAR(samples(0, 10), 0.1 * std::pow(10 / 19.0, 3), 1e-15);
}

TEST(SampleArcLength, SpacesCubicsEvenly) {
  Eigen::Matrix<double, 3, 4> control = Eigen::Matrix<double, 3, 4>::Zero();
  control.row(0) << 0, 0, 0, 0.1;
  const Eigen::Matrix3Xd samples = sample_arc_length(one_cubic(control), 0.0049);
  ASSERT_EQ(samples.cols(), 21);
  for (int i = 0; i <= 20; ++i) EXPECT_NEAR(samples(0, i), 0.005 * i, 1e-12);
}

TEST(SampleArcLength, KeepsShortAndDegeneratePrimitives) {
  EXPECT_EQ(sample_arc_length(one_line({0, 0, 0}, {0.001, 0, 0}), 0.005).cols(), 2);
  const Eigen::Matrix3Xd still =
      sample_arc_length(one_cubic(Eigen::Matrix<double, 3, 4>::Ones()), 0.005);
  ASSERT_EQ(still.cols(), 2);
  EXPECT_TRUE(still.isOnes(1e-12));
}

TEST(SampleSegments, RunsFromTheSecondPointToTheFirstAndRepeatsJoints) {
  const Eigen::Matrix3Xd samples =
      sample_segments(points({{0, 0, 0}, {0.1, 0, 0}, {0.1, 0.1, 0}, {0.1, 0.104, 0}}), 0.005);
  ASSERT_EQ(samples.cols(), 40) << "the last segment is too short for a sample";
  EXPECT_EQ(samples.col(0), Eigen::Vector3d(0.1, 0, 0));
  EXPECT_EQ(samples.col(19), Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(samples.col(39), Eigen::Vector3d(0.1, 0, 0));
}

TEST(Densify, CutsEverySegmentAndKeepsItsEnds) {
  const Eigen::Matrix3Xd dense = densify(points({{0, 0, 0}, {1, 0, 0}, {1, 0.1, 0}}), 0.25);
  ASSERT_EQ(dense.cols(), 6);
  EXPECT_EQ(dense.col(1), Eigen::Vector3d(0.25, 0, 0));
  EXPECT_EQ(dense.col(5), Eigen::Vector3d(1, 0.1, 0));
  EXPECT_EQ(densify(Eigen::Matrix3Xd(3, 0), 0.25).cols(), 0);
  EXPECT_EQ(densify(points({{1, 2, 3}}), 0.25).cols(), 1);
}

TEST(VoxelAverage, TakesTheMeanOfEachVoxelAndKeepsPointsOutside) {
  // Voxels of side 1 over [0, 4]^3.
  const Eigen::Matrix3Xd means =
      voxel_average(points({{0.2, 0, 0}, {0.6, 0, 0}, {1.1, 0, 0}, {-7.5, 0, 0}}), 4, 0, 4);
  ASSERT_EQ(means.cols(), 3);
  EXPECT_NEAR(means(0, 0), -7.5, 1e-15);
  EXPECT_NEAR(means(0, 1), 0.4, 1e-15);
  EXPECT_NEAR(means(0, 2), 1.1, 1e-15);
}

TEST(NearestPoints, AgreeWithBruteForce) {
  const Eigen::Matrix3Xd some = Eigen::Matrix3Xd::Random(3, 500);
  const Eigen::Matrix3Xd queries = 1.5 * Eigen::Matrix3Xd::Random(3, 300);
  const Eigen::VectorXd distances = NearestPoints(some).distances(queries);
  for (Eigen::Index i = 0; i < queries.cols(); ++i) {
    EXPECT_NEAR(distances[i], (some.colwise() - queries.col(i)).colwise().norm().minCoeff(), 1e-14);
  }
}

TEST(NearestPoints, AreInfinitelyFarIfThereAreNone) {
  const NearestPoints none(Eigen::Matrix3Xd(3, 0));
  EXPECT_TRUE(std::isinf(none.distances(points({{0, 0, 0}}))[0]));
  EXPECT_EQ(NearestPoints(points({{0, 0, 0}})).distances(Eigen::Matrix3Xd(3, 0)).size(), 0);
}

TEST(NearestPoints, BearManyEqualPoints) {
  const NearestPoints same(Eigen::Matrix3Xd::Ones(3, 1000));
  EXPECT_NEAR(same.distances(points({{1, 1, 3}}))[0], 2, 1e-15);
}

TEST(Score, HasKnownNumbers) {
  // Distances to the truth: 0, 0.004, 0.5; to the prediction: 0, 0.1 (from (0.1, 0, 0)).
  const Score s = score(points({{0, 0, 0}, {0, 0.004, 0}, {0, 0, 0.5}}),
                        points({{0, 0, 0}, {0.1, 0, 0}}), {0.005});
  EXPECT_NEAR(s.accuracy, 0.504 / 3, 1e-15);
  EXPECT_NEAR(s.completeness, 0.05, 1e-15);
  EXPECT_NEAR(s.levels[0].precision, 200 / 3.0, 1e-12);
  EXPECT_NEAR(s.levels[0].recall, 50, 1e-12);
  EXPECT_NEAR(s.levels[0].f, 100 * 2 * (2 / 3.0) * 0.5 / (2 / 3.0 + 0.5 + 1e-7), 1e-12);
}

TEST(Score, ThresholdsAreStrict) {
  const Score s = score(points({{0, 0, 0.25}}), points({{0, 0, 0}}), {0.25, 0.2500001});
  EXPECT_EQ(s.levels[0].precision, 0);
  EXPECT_EQ(s.levels[0].f, 0);
  EXPECT_EQ(s.levels[1].precision, 100);
}

TEST(Score, OfAnEmptyPredictionIsNoNumberAndZeroShares) {
  const Score s = score(Eigen::Matrix3Xd(3, 0), points({{0, 0, 0}}), {0.005});
  EXPECT_TRUE(std::isnan(s.accuracy));
  EXPECT_TRUE(std::isnan(s.completeness));
  EXPECT_EQ(s.levels[0].precision, 0);
  EXPECT_EQ(s.levels[0].recall, 0);
  EXPECT_EQ(s.levels[0].f, 0);
}

TEST(AsFloat, RoundsToSinglePrecision) {
  EXPECT_EQ(as_float(points({{0.1, 0, 0}}))(0, 0), double(0.1f));
}

TEST(SpreadOf, InterpolatesBetweenRanks) {
  Eigen::VectorXd five(5), four(4);
  five << 4, 0, 3, 1, 2;
  four << 3, 0, 1, 2;
  EXPECT_EQ(spread_of(five).median, 2);
  EXPECT_NEAR(spread_of(five).p95, 3.8, 1e-12);
  EXPECT_EQ(spread_of(five).worst, 4);
  EXPECT_EQ(spread_of(four).median, 1.5);
  EXPECT_NEAR(spread_of(four).p95, 2.85, 1e-12);
  EXPECT_EQ(spread_of(Eigen::VectorXd::Constant(1, 7)).p95, 7);
  EXPECT_TRUE(std::isnan(spread_of({}).worst));
}

// Truth at x = 0, 1, 2, 3; prediction at 0 and 1 exactly.
TEST(Score, RecallOfWhatCanBeSeenIsOfThatAlone) {
  Eigen::Matrix3Xd truth = Eigen::Matrix3Xd::Zero(3, 4);
  truth.row(0) << 0, 1, 2, 3;
  const Eigen::Matrix3Xd prediction = truth.leftCols(2);
  const Score s = score(prediction, truth, {0.5}, {true, true, true, false});
  EXPECT_EQ(s.visible_samples, 3);
  EXPECT_EQ(s.levels[0].recall, 50);
  EXPECT_NEAR(s.levels[0].recall_visible, 200 / 3.0, 1e-12);
  EXPECT_NEAR(s.levels[0].f_visible, 80, 1e-4) << "precision stays 100";
  EXPECT_EQ(s.completeness, 0.75);
  EXPECT_NEAR(s.completeness_visible, 1 / 3.0, 1e-12);
  EXPECT_EQ(s.to_prediction.worst, 2);
  EXPECT_EQ(s.to_truth.worst, 0);
  EXPECT_TRUE(std::isnan(score(prediction, truth, {0.5}).levels[0].recall_visible));
  const Score blind = score(prediction, truth, {0.5}, {false, false, false, false});
  EXPECT_TRUE(std::isnan(blind.levels[0].f_visible)) << "nothing to recall";
}

}  // namespace
}  // namespace sketchsplat
