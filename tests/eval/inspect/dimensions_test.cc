// SPDX-License-Identifier: MIT
#include "eval/inspect/dimensions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "eval/inspect/iso2768.h"
#include "tests/eval/inspect/plate.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;

SigmaModel plain() {
  SigmaModel sigma;  // without a footprint: covariances as they are
  without_tails(&sigma.options);
  return sigma;
}

std::vector<DimensionCheck> dimensions_of(const Sketch& part, const Nominal& nominal) {
  const Association a = associate(part, nominal, {});
  return measure_dimensions(find_dimensions(nominal, a), nominal, a, part, plain());
}

std::vector<double> values_of(const std::vector<DimensionCheck>& all, DimensionKind kind) {
  std::vector<double> out;
  for (const DimensionCheck& d : all)
    if (d.dimension.kind == kind) out.push_back(std::round(1e6 * d.dimension.nominal) / 1e6);
  std::sort(out.begin(), out.end());
  return out;
}

TEST(Dimensions, AreThoseOfADrawing) {
  const Nominal nominal = make_nominal(plate(), "plate");
  const auto all = dimensions_of(plate(), nominal);
  using testing::ElementsAre;
  EXPECT_THAT(values_of(all, DimensionKind::kDiameter), ElementsAre(8, 8, 8, 8, 18, 18));
  EXPECT_THAT(values_of(all, DimensionKind::kPlaneDistance), ElementsAre(10, 60, 100));
  const double far = std::round(1e6 * std::hypot(55, 10)) / 1e6;
  EXPECT_THAT(values_of(all, DimensionKind::kCentreDistance), ElementsAre(30, 30, far, far));
  EXPECT_EQ(values_of(all, DimensionKind::kPlaneAngle), std::vector<double>(12, 90));
  EXPECT_EQ(values_of(all, DimensionKind::kEdgeAngle), std::vector<double>(24, 90));
  EXPECT_EQ(values_of(all, DimensionKind::kEdgeDistance).size(), 12u);
  for (const DimensionCheck& d : all) {
    EXPECT_TRUE(d.measured) << d.dimension.name;
    EXPECT_NEAR(d.value, d.dimension.nominal, 1e-9) << d.dimension.name;
    EXPECT_EQ(d.sigma, 0) << d.dimension.name;
  }
}

TEST(Dimensions, APatternOfHolesHasAPitchCircle) {
  Sketch s = box({100, 100, 10});
  for (int k = 0; k < 5; ++k)
    s.add_stroke(StrokeKind::kCircle, -1, -1,
                 {{50 + 30 * std::cos(1.2566370614 * k), 50 + 30 * std::sin(1.2566370614 * k), 10},
                  {0, 0, 4}});
  const auto all = dimensions_of(s, make_nominal(s, "flange"));
  EXPECT_THAT(values_of(all, DimensionKind::kPitchDiameter), testing::ElementsAre(60));
}

TEST(Dimensions, WhatWasNotMeasuredIsNot) {
  std::vector<bool> keep(size_t(plate().size()), true);
  keep[12] = false;
  const Nominal nominal = make_nominal(plate(), "plate");
  for (const DimensionCheck& d : dimensions_of(keep_strokes(plate(), keep), nominal)) {
    const auto& f = d.dimension.features;
    const bool of_hole = std::any_of(f.begin(), f.end(), [](const FeatureRef& r) {
      return r.kind == FeatureKind::kCircle && r.index == 12;
    });
    EXPECT_EQ(d.measured, !of_hole) << d.dimension.name;
  }
}

TEST(Dimensions, SigmasForetellHowTheyScatterUnderNoise) {
  constexpr double kSigma = 0.02;
  constexpr int kDraws = 150;
  const Nominal nominal = make_nominal(plate(), "plate");
  const Sketch part = with_sigma(plate(), kSigma);
  std::mt19937 random(5);
  std::vector<double> squares, foretold, bias;
  std::vector<std::string> names;
  for (int i = 0; i < kDraws; ++i) {
    const auto all = dimensions_of(noisy(part, kSigma, &random), nominal);
    squares.resize(all.size()), foretold.resize(all.size()), names.resize(all.size());
    for (size_t k = 0; k < all.size(); ++k) {
      squares[k] += std::pow(all[k].value - all[k].dimension.nominal, 2) / kDraws;
      foretold[k] += all[k].sigma * all[k].sigma / kDraws;
      names[k] = all[k].dimension.name;
    }
  }
  for (size_t k = 0; k < squares.size(); ++k)
    EXPECT_NEAR(std::sqrt(squares[k] / foretold[k]), 1, 0.25) << names[k];
}

TEST(Iso2768, SaysWhatTheStandardSays) {
  EXPECT_EQ(iso2768_linear(Iso2768::kMedium, 30), 0.2);
  EXPECT_EQ(iso2768_linear(Iso2768::kMedium, 30.001), 0.3);
  EXPECT_EQ(iso2768_linear(Iso2768::kFine, 0.5), 0.05);
  EXPECT_EQ(iso2768_linear(Iso2768::kCoarse, 2), 0.2);
  EXPECT_EQ(iso2768_linear(Iso2768::kVeryCoarse, 5), 0.5);
  EXPECT_EQ(iso2768_linear(Iso2768::kFine, 1500), 0.5);
  EXPECT_EQ(iso2768_linear(Iso2768::kMedium, 3000), 2);
  EXPECT_EQ(iso2768_linear(Iso2768::kVeryCoarse, 1), 0.5) << "none: the nearest that has one";
  EXPECT_EQ(iso2768_linear(Iso2768::kFine, 3000), 0.5);
  EXPECT_NEAR(iso2768_angle(Iso2768::kMedium, 10), 1, 1e-12);
  EXPECT_NEAR(iso2768_angle(Iso2768::kFine, 100), 20 / 60.0, 1e-12);
  EXPECT_NEAR(iso2768_angle(Iso2768::kVeryCoarse, 1000), 20 / 60.0, 1e-12);
  EXPECT_EQ(iso2768_linear(Iso2768::kNone, 10), 0);
}

}  // namespace
}  // namespace sketchsplat
