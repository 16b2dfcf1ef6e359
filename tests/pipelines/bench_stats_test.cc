// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "pipelines/bench/stats.h"

namespace sketchsplat {
namespace {

TEST(DropPoint, IsInterpolatedBetweenTheLevelsAroundIt) {
  // 98 at 2 and 88 at 4: 93 lies half way.
  const auto point = drop_point({0, 1, 2, 4, 8}, {98, 98, 98, 88, 0}, 5, false);
  ASSERT_TRUE(point);
  EXPECT_DOUBLE_EQ(*point, 3);
}

TEST(DropPoint, OfALogarithmicAxisIsInterpolatedInTheLogarithm) {
  EXPECT_NEAR(*drop_point({50, 8, 2}, {100, 100, 90}, 5, true), 4, 1e-12);
  EXPECT_NEAR(*drop_point({0, 2}, {100, 90}, 5, true), 1, 1e-12) << "0 has no logarithm";
}

TEST(DropPoint, IsTheFirstEvenIfTheValueRisesAgain) {
  EXPECT_DOUBLE_EQ(*drop_point({0, 1, 2, 3}, {90, 80, 90, 0}, 5, false), 0.5);
}

TEST(DropPoint, CountsFromTheHarmlessValueNotFromTheBest) {
  EXPECT_DOUBLE_EQ(*drop_point({0, 1, 2}, {90, 100, 80}, 5, false), 1.75);
}

TEST(DropPoint, IsNoneWhereTheValueStaysAndExactlyAtALevelThatIsJustLowEnough) {
  EXPECT_FALSE(drop_point({0, 1}, {90, 85.1}, 5, false));
  EXPECT_DOUBLE_EQ(*drop_point({0, 1}, {90, 85}, 5, false), 1);
  EXPECT_FALSE(drop_point({}, {}, 5, false));
}

TEST(DropPoint, PassesOverLevelsWithoutAValue) {
  EXPECT_DOUBLE_EQ(*drop_point({0, 1, 2, 3}, {NAN, 90, NAN, 80}, 5, false), 2);
  EXPECT_FALSE(drop_point({0, 1}, {NAN, NAN}, 5, false));
}

TEST(PowerLaw, IsFoundFromItsOwnPoints) {
  std::vector<double> x, y;
  for (const double v : {1.0, 3.0, 10.0, 50.0})
    x.push_back(v), y.push_back(0.25 * std::pow(v, 1.5));
  const PowerLaw law = fit_power_law(x, y);
  EXPECT_NEAR(law.exponent, 1.5, 1e-12);
  EXPECT_NEAR(law.factor, 0.25, 1e-12);
  EXPECT_NEAR(law.error, 0, 1e-7);
  EXPECT_EQ(law.points, 4);
}

TEST(PowerLaw, ErrorIsThatOfARegressionOnLogarithms) {
  // log y - log x = +d, -2d, +d at equal steps of log x: slope 1, residuals of variance 6 d^2.
  const double d = 0.1, e = std::exp(1);
  const PowerLaw law =
      fit_power_law({1, e, e * e}, {std::exp(d), e * std::exp(-2 * d), e * e * std::exp(d)});
  EXPECT_NEAR(law.exponent, 1, 1e-12);
  EXPECT_NEAR(law.error, d * std::sqrt(6 / 2.0), 1e-12);
}

TEST(PowerLaw, LeavesOutWhatHasNoLogarithmAndNeedsTwoPlaces) {
  const PowerLaw law = fit_power_law({0, 1, 2, 4, 8}, {5, 1, 2, NAN, 8});
  EXPECT_EQ(law.points, 3);
  EXPECT_NEAR(law.exponent, 1, 1e-12);
  EXPECT_TRUE(std::isnan(fit_power_law({2, 2}, {1, 3}).exponent));
  EXPECT_TRUE(std::isnan(fit_power_law({}, {}).exponent));
  EXPECT_TRUE(std::isnan(fit_power_law({1, 2}, {1, 2}).error));
}

TEST(Summary, IsOfTheFiniteValues) {
  const Summary s = summary_of({1, NAN, 4});
  EXPECT_EQ(s.count, 2);
  EXPECT_DOUBLE_EQ(s.mean, 2.5);
  EXPECT_DOUBLE_EQ(s.low, 1);
  EXPECT_DOUBLE_EQ(s.high, 4);
  EXPECT_TRUE(std::isnan(summary_of({NAN}).mean));
}

}  // namespace
}  // namespace sketchsplat
