// SPDX-License-Identifier: MIT
#include "eval/inspect/prior.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "datasets/types/dense.h"

namespace sketchsplat {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;

std::vector<EdgePlace> straight_places(int count) {
  std::vector<EdgePlace> out(count);
  for (int i = 0; i < count; ++i) {
    out[i].nominal = Vector3d(i, 0, 0);
    out[i].tangent = Vector3d::UnitX();
  }
  return out;
}

// Errors as large as expected; and a tenth of them 2.5 times as large.
ErrorShares exact() { return {0, 0, 0, 0, 1, 0, 0, 0, 0}; }
ErrorShares tailed() { return {0, 0, 0, 0, 0.9, 0, 0.1, 0, 0}; }

TEST(Prior, LearnsHowLargeDeviationsAre) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal(0, 1);
  const DeviationPrior vague = vague_prior(1);
  std::vector<std::vector<double>> evidence;
  for (int i = 0; i < 400; ++i) {
    const double off = 2 * normal(random) + 0.1 * normal(random);
    std::vector<double> logs;
    for (const double scale : vague.scales)
      logs.push_back(number_log_evidence(off, {0.1, exact()}, scale));
    evidence.push_back(logs);
  }
  const DeviationPrior prior = learn_prior(vague, evidence);
  EXPECT_NEAR(std::accumulate(prior.weights.begin(), prior.weights.end(), 0.0), 1, 1e-12);
  double mean = 0;
  for (size_t k = 0; k < prior.scales.size(); ++k)
    mean += prior.weights[k] * prior.scales[k] * prior.scales[k];
  EXPECT_NEAR(std::sqrt(mean), 2, 0.3);
}

TEST(Prior, WhatIsMeasuredExactlyDoesNotDependOnIt) {
  for (const double off : {0.0, 0.9, 1.1, 20.0})
    EXPECT_NEAR(number_probability(off, {1e-6, tailed()}, 1, vague_prior(1)), off < 1, 1e-9) << off;
}

TEST(Prior, AnErrorAsLargeAsTheToleranceLeavesItOpen) {
  const double p = number_probability(0, {1, tailed()}, 1, vague_prior(1));
  EXPECT_GT(p, 0.5);
  EXPECT_LT(p, 0.95);
}

// Parts of which some edges are as nominal and some are not; the probabilities are those of what is
// there, whatever the size of the errors.
TEST(Prior, ProbabilitiesAreRight) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal(0, 1);
  for (const double sigma : {0.1, 0.5, 1.5}) {
    std::vector<double> off, stated(10), within(10), count(10);
    std::vector<bool> in;
    const DeviationPrior vague = vague_prior(1);
    std::vector<std::vector<double>> evidence;
    for (int i = 0; i < 4000; ++i) {
      const double there = i % 2 ? 0 : 3 * normal(random);
      off.push_back(there + sigma * normal(random));
      in.push_back(std::abs(there) <= 1);
      std::vector<double> logs;
      for (const double scale : vague.scales)
        logs.push_back(number_log_evidence(off[i], {sigma, exact()}, scale));
      evidence.push_back(logs);
    }
    const DeviationPrior prior = learn_prior(vague, evidence);
    for (int i = 0; i < 4000; ++i) {
      const double p = number_probability(off[i], {sigma, exact()}, 1, prior);
      const int bin = std::min(9, int(10 * p));
      stated[bin] += p, within[bin] += in[i], ++count[bin];
    }
    for (int k = 0; k < 10; ++k)
      if (count[k] >= 100) {
        EXPECT_NEAR(stated[k] / count[k], within[k] / count[k], 0.1) << sigma << " " << k;
      }
  }
}

PieceErrors measured_at(const std::vector<EdgePlace>& places, const Vector3d& shift, double sigma) {
  PieceErrors errors;
  errors.shares = exact();
  const int n = int(places.size());
  errors.model.mean.resize(2, n);
  errors.model.modes = MatrixXd::Zero(2 * n, 3);
  for (int j = 0; j < n; ++j) {
    errors.model.mean.col(j) = frame_across(places[j].tangent) * shift;
    errors.model.modes.middleRows<2>(2 * j) = sigma * frame_across(places[j].tangent);
  }
  return errors;
}

TEST(Prior, APieceThatWasMeasuredExactlyIsWhereItWasMeasured) {
  const auto places = straight_places(5);
  PieceErrors errors = measured_at(places, {0, 0.3, -0.1}, 0);
  errors.model.mean(0, 2) += 0.05;  // a wave
  const PieceLikelihood piece(errors, rigid_deviations(places), 0.01);
  for (const DeviationModel& m : piece.posterior(vague_prior(1)).parts) {
    EXPECT_LT((m.mean - errors.model.mean).norm(), 1e-3);
    EXPECT_LT(m.modes.norm(), 1e-3);
  }
  EXPECT_GT(piece.log_evidence(0.5), piece.log_evidence(0.125));
  EXPECT_GT(piece.log_evidence(0.5), piece.log_evidence(8));
}

TEST(Prior, WhatIsWithinErrorsIsDrawnToWhatIsExpected) {
  const auto places = straight_places(2);
  const PieceLikelihood piece(measured_at(places, {0, 0.3, 0}, 0.3), rigid_deviations(places),
                              0.01);
  DeviationPrior small = vague_prior(1), large = vague_prior(1);
  small.weights.assign(small.scales.size(), 0);
  large.weights = small.weights;
  small.weights.front() = large.weights.back() = 1;
  const DeviationMixture near = piece.posterior(small), far = piece.posterior(large);
  EXPECT_LT(near.parts[0].mean.col(0).norm(), 0.06);
  EXPECT_NEAR(far.parts[0].mean.col(0).norm(), 0.3, 0.01);
}

// The views could not tell what shape it has.
TEST(Prior, OfAStrokeOfASimplerKindTheWavesDoNotCount) {
  const auto places = straight_places(5);
  PieceErrors errors = measured_at(places, {0, 0.3, -0.1}, 0);
  for (int j = 0; j < 5; ++j) errors.model.mean(0, j) += j % 2 ? 2 : -2;
  const MatrixXd rigid = rigid_deviations(places);
  const auto largest = [&] {
    const DeviationMixture there = PieceLikelihood(errors, rigid, 0.01).posterior(vague_prior(1));
    return there.parts[0].mean.colwise().norm().maxCoeff();
  };
  EXPECT_GT(largest(), 1.5);
  errors.simpler = true;
  EXPECT_LT(largest(), 1);
}

TEST(Prior, SizesOfErrorsHaveTheStandardDeviationThatIsSaid) {
  for (const ErrorShares& shares : {exact(), tailed(), SigmaOptions().arc.shares}) {
    double sum = 0, mean_square = 0;
    for (size_t k = 0; k < shares.size(); ++k) {
      sum += shares[k];
      mean_square += shares[k] * sizes_of(shares)[k] * sizes_of(shares)[k];
    }
    EXPECT_NEAR(sum, 1, 1e-9);
    EXPECT_NEAR(mean_square, 1, 1e-9);
  }
}

std::vector<EdgePlace> circle_places() {
  std::vector<EdgePlace> circle(12);
  for (int i = 0; i < 12; ++i) {
    const double a = M_PI * i / 6;
    circle[i].nominal = Vector3d(std::cos(a), std::sin(a), 0);
    circle[i].tangent = Vector3d(-std::sin(a), std::cos(a), 0);
  }
  return circle;
}

// One thing is wrong with it, six are right, and nearly all other edges are right altogether.
TEST(Prior, ABoreOfTheWrongSizeIsWrongThoughEverythingElseIsRight) {
  const auto places = circle_places();
  const MatrixXd rigid = rigid_deviations(places);
  PieceErrors errors;
  errors.shares = tailed();
  errors.model.mean = MatrixXd((4 * rigid.col(6)).reshaped(2, 12));
  errors.model.modes = 0.3 * rigid;
  DeviationPrior prior = vague_prior(1);
  for (size_t k = 0; k < prior.weights.size(); ++k) prior.weights[k] = k == 0 ? 0.96 : 0.005;
  const DeviationMixture there = PieceLikelihood(errors, rigid, 0.1).posterior(prior);
  EXPECT_LT(share_within(draw_largest({there}), 1), 0.01);
}

TEST(Prior, ARigidMoveOfACircleHasSixWays) {
  const std::vector<EdgePlace> circle = circle_places();
  const auto ways = [](const std::vector<EdgePlace>& places) {
    const Eigen::VectorXd values = svd(rigid_deviations(places)).values;
    return (values.array() > 1e-9 * values[0]).count();
  };
  EXPECT_EQ(ways(circle), 6);
  EXPECT_EQ(ways(straight_places(5)), 4);
}

}  // namespace
}  // namespace sketchsplat
