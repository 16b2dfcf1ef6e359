// SPDX-License-Identifier: MIT
#include "pipelines/adjust/choose_standards.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace sketchsplat {
namespace {

constexpr double kPrice = 3;

MeasuredLengths lengths(std::vector<double> values, double sigma, bool diameters = true) {
  MeasuredLengths out;
  out.value = Eigen::Map<Eigen::VectorXd>(values.data(), Eigen::Index(values.size()));
  out.covariance = sigma * sigma * Eigen::MatrixXd::Identity(out.value.size(), out.value.size());
  out.diameter.assign(values.size(), diameters);
  return out;
}

std::vector<double> standards_of(const StandardChoice& chosen) {
  std::vector<double> out;
  for (const ChosenStandard& c : chosen.lengths) out.push_back(c.standard.value);
  std::sort(out.begin(), out.end());
  return out;
}

TEST(StandardSeries, NamesWhatADesignerWouldSay) {
  const auto name = [](StandardSystem system, bool diameter, double value) {
    const auto near = standards_near(system, diameter, value, 1e-6);
    return near.size() == 1 ? near[0].series : "";
  };
  EXPECT_EQ(name(StandardSystem::kIso, false, 40), "whole 10 mm");
  EXPECT_EQ(name(StandardSystem::kIso, false, 63), "R5");
  EXPECT_EQ(name(StandardSystem::kIso, false, 1.25), "R10");
  EXPECT_EQ(name(StandardSystem::kIso, true, 6.8), "tap drill ISO 2306");
  EXPECT_EQ(name(StandardSystem::kIso, true, 2.05), "tap drill ISO 2306");
  EXPECT_EQ(name(StandardSystem::kIso, true, 14.25), "drill ISO 235");
  EXPECT_EQ(name(StandardSystem::kIso, false, 14.25), "");
  EXPECT_EQ(name(StandardSystem::kInch, false, 0.375), "1/8 in");
  EXPECT_EQ(name(StandardSystem::kInch, true, 0.201), "tap drill");
  EXPECT_EQ(name(StandardSystem::kInch, true, 0.413), "drill B94.11M");
  EXPECT_TRUE(standards_near(StandardSystem::kNone, true, 10, 1).empty());
}

TEST(StandardSeries, EntriesAreCheaperToNameTheRarerTheyAre) {
  const auto spacing = [](double value) {
    return standards_near(StandardSystem::kIso, false, value, 1e-6).at(0).spacing;
  };
  EXPECT_GT(spacing(100), spacing(90));
  EXPECT_GT(spacing(90), spacing(91));
  EXPECT_GT(spacing(91), spacing(91.5));
  EXPECT_GT(spacing(91.5), spacing(91.3));
  EXPECT_NEAR(spacing(91.3), 0.1 / 9, 1e-9);
  // Neighbours in the next decade count: 8, 10, 12.5.
  EXPECT_NEAR(standards_near(StandardSystem::kIso, false, 8, 1e-6)[0].spacing,
              ((10 - 6.3) / 2 + (9 - 7.1) / 2 + (8.5 - 7.5) / 2 + 1 + 0.5 + 0.1) / 9, 1e-9);
}

TEST(ChooseStandards, TakesWhatLiesWithinSigmaOfStandardLengths) {
  const auto chosen =
      choose_standards(lengths({8.002, 6.799, 31.5, 25.38}, 0.002), StandardSystem::kIso, kPrice);
  EXPECT_EQ(standards_of(chosen), (std::vector<double>{6.8, 8, 31.5}));
  for (const ChosenStandard& c : chosen.lengths) EXPECT_GT(c.nats, 0);
}

TEST(ChooseStandards, LeavesALengthThreeSigmaOff) {
  EXPECT_TRUE(
      choose_standards(lengths({10.012}, 0.004), StandardSystem::kIso, kPrice).lengths.empty());
  EXPECT_TRUE(
      choose_standards(lengths({10 + 3e-6}, 1e-6), StandardSystem::kIso, kPrice).lengths.empty());
}

TEST(ChooseStandards, LeavesWhatIsAmbiguousBecauseSigmaIsWide) {
  for (const double sigma : {0.2, 0.5, 2.0})
    EXPECT_TRUE(choose_standards(lengths({10, 8, 3.3}, sigma), StandardSystem::kIso, kPrice)
                    .lengths.empty())
        << sigma;
}

TEST(ChooseStandards, RandomLengthsAreHardlyEverTaken) {
  std::vector<double> values;
  for (int i = 0; i < 250; ++i) values.push_back(5 + 40 * std::fmod(i * 0.6180339887, 1.0));
  for (const double sigma : {0.001, 0.01, 0.1})
    EXPECT_LT(choose_standards(lengths(values, sigma), StandardSystem::kIso, kPrice).lengths.size(),
              40u)
        << sigma;
}

// A scale that is off by half its sigma.
TEST(ChooseStandards, LengthsThatShareAScaleAreJudgedTogetherInAnyOrder) {
  const std::vector<double> truth = {20, 8, 12.5, 50, 31.5, 3.17, 40};
  std::vector<double> values;
  for (const double t : truth) values.push_back(t * 1.0005);
  std::vector<int> order = {0, 1, 2, 3, 4, 5, 6};
  for (int round = 0; round < 5; ++round) {
    std::vector<double> shuffled;
    for (const int i : order) shuffled.push_back(values[i]);
    MeasuredLengths l = lengths(shuffled, 0.002);
    l.scale_sigma = 1e-3;
    const auto chosen = choose_standards(l, StandardSystem::kIso, kPrice);
    EXPECT_EQ(standards_of(chosen), (std::vector<double>{8, 12.5, 20, 31.5, 40, 50})) << round;
    EXPECT_NEAR(chosen.scale, 1 / 1.0005, 5e-5);
    EXPECT_LT(chosen.scale_sigma, 5e-5);
    std::rotate(order.begin(), order.begin() + 3, order.end());
    std::swap(order[1], order[4]);
  }
}

TEST(ChooseStandards, WhatOthersDetermineSavesNothing) {
  // The third is the sum of the first two.
  MeasuredLengths l = lengths({10, 20, 30}, 0.01, false);
  Eigen::MatrixXd by(3, 2);
  by << 1, 0, 0, 1, 1, 1;
  l.covariance = 1e-4 * by * by.transpose();
  EXPECT_EQ(choose_standards(l, StandardSystem::kIso, kPrice).lengths.size(), 2u);
}

}  // namespace
}  // namespace sketchsplat
