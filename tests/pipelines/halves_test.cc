// SPDX-License-Identifier: MIT
#include "pipelines/cameras/halves.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>

namespace sketchsplat {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
constexpr int kUnknowns = 6, kTrials = 2000;

// Least squares of 60 numbers in each half, as they scatter by one, with unknowns off by `error`.
Halves halves_of(double error, std::mt19937* random) {
  std::normal_distribution<double> normal;
  Halves out;
  for (const int half : {0, 1}) {
    MatrixXd J(60, kUnknowns);
    for (double& v : J.reshaped()) v = normal(*random);
    VectorXd residual = J * VectorXd::Constant(kUnknowns, error);
    for (double& v : residual) v += normal(*random);
    out.hessian[half] = J.transpose() * J;
    out.gradient[half] = J.transpose() * residual;
  }
  return out;
}

struct Moments {
  double mean = 0, deviation = 0;
};
template <typename Statistic>
Moments moments(double error, const Statistic& statistic) {
  std::mt19937 random(7);
  double sum = 0, squares = 0;
  for (int i = 0; i < kTrials; ++i) {
    const double x = statistic(halves_of(error, &random));
    sum += x / kTrials, squares += x * x / kTrials;
  }
  return {sum, std::sqrt(squares - sum * sum)};
}

const MatrixXd kPrior = MatrixXd::Identity(kUnknowns, kUnknowns);

TEST(Halves, WhereUnknownsAreRightChanceIsAsWideAsIsSaid) {
  const Moments by_moves =
      moments(0, [](const Halves& h) { return confirm(h, kPrior).sigmas; });
  EXPECT_NEAR(by_moves.mean, 0, 0.1);
  EXPECT_LT(by_moves.deviation, 1.05 * std::sqrt(2.0)) << "of two that hang together";
  EXPECT_GT(by_moves.deviation, 1);
  const Moments by_gradients = moments(0, [](const Halves& h) { return alike(h, kPrior); });
  EXPECT_NEAR(by_gradients.mean, 0, 0.1);
  EXPECT_NEAR(by_gradients.deviation, 1, 0.1);
}

TEST(Halves, WhereUnknownsAreWrongBothSaySo) {
  EXPECT_GT(moments(0.5, [](const Halves& h) { return confirm(h, kPrior).sigmas; }).mean, 5);
  EXPECT_GT(moments(0.5, [](const Halves& h) { return alike(h, kPrior); }).mean, 5);
}

TEST(Halves, NothingKnownIsNothingSaid) {
  Halves none;
  for (const int half : {0, 1}) {
    none.hessian[half] = MatrixXd::Zero(kUnknowns, kUnknowns);
    none.gradient[half] = VectorXd::Zero(kUnknowns);
  }
  EXPECT_EQ(confirm(none, kPrior).sigmas, 0);
  EXPECT_EQ(alike(none, kPrior), 0);
}

}  // namespace
}  // namespace sketchsplat
