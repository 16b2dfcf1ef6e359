// SPDX-License-Identifier: MIT
#include "pipelines/results/known_scale.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "datasets/types/errors.h"
#include "sketches/solve/covariance.h"

namespace sketchsplat {
namespace {

using testing::HasSubstr;

// A square of 2 x 2, a circle of radius 0.5 above it, a smaller one, and an arc of radius 0.75.
Sketch part() {
  Sketch s;
  for (const auto& p : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(2, 0, 0),
                        Eigen::Vector3d(2, 2, 0), Eigen::Vector3d(0, 2, 0)})
    s.add_node(p);
  for (int i = 0; i < 4; ++i) s.add_stroke(StrokeKind::kLine, i, (i + 1) % 4, {});
  s.add_stroke(StrokeKind::kCircle, -1, -1, {{1, 1, 3}, {0, 0, 0.5}});
  s.add_stroke(StrokeKind::kCircle, -1, -1, {{1, 1, 2}, {0, 0, 0.25}});
  const int a = s.add_node({0.25, 1, 1}), b = s.add_node({1.75, 1, 1});
  s.add_stroke(StrokeKind::kArc, a, b, {{1, 1.75, 1}});
  for (Evidence& e : s.evidence) e.sigma = 1e-3;
  return s;
}

KnownScale scaled(const std::string& by, LengthUnit unit = LengthUnit::kMillimetre,
                  const std::vector<TagSquare>& tags = {}) {
  CadOptions options;
  options.scale_by = by;
  options.unit = unit;
  return known_scale(options, part(), 1e-3, tags);
}

TagSquare tag(int id, double side, double sigma) {
  TagSquare t;
  t.id = id, t.side = side, t.sigma = sigma;
  return t;
}

TEST(KnownScale, IsTheStatedLengthOverThatOfWhatItNames) {
  EXPECT_DOUBLE_EQ(scaled("size=30").units_per_world, 10);  // from z = 0 to 3
  EXPECT_NEAR(scaled("diameter=25.4").units_per_world, 25.4, 1e-9);
  EXPECT_NEAR(scaled("circle:4=25.4").units_per_world, 25.4, 1e-9);
  EXPECT_NEAR(scaled("circle:5=10").units_per_world, 20, 1e-9);
  EXPECT_NEAR(scaled("arc:6=15").units_per_world, 10, 1e-9);
  EXPECT_NEAR(scaled("line:1=80").units_per_world, 40, 1e-9);
  EXPECT_NEAR(scaled("nodes:0-2=28.2842712474619").units_per_world, 10, 1e-9);
  const KnownScale s = scaled("line:1=80");
  EXPECT_EQ(s.source, "--scale-by line:1=80");
  EXPECT_GT(s.sigma_relative, 0);
  EXPECT_LT(s.sigma_relative, 1e-2);
}

TEST(KnownScale, LengthsMayCarryAUnitOfTheirOwn) {
  EXPECT_NEAR(scaled("circle:4=1in").units_per_world, 25.4, 1e-9);
  EXPECT_NEAR(scaled("circle:4=1 inch", LengthUnit::kCentimetre).units_per_world, 2.54, 1e-9);
  EXPECT_NEAR(scaled("line:0=8cm", LengthUnit::kMetre).units_per_world, 0.04, 1e-12);
  EXPECT_NEAR(scaled("line:0=8", LengthUnit::kMetre).units_per_world, 4, 1e-12);
}

// Twice the spread of the radius, as the covariance has it.
TEST(KnownScale, SigmaOfADiameterIsThatOfItsAxis) {
  Sketch s = part();
  Eigen::MatrixXd c = Eigen::MatrixXd::Zero(6, 6);
  c(5, 5) = 4e-4 * 4e-4;
  for (int k = 0; k < 5; ++k) c(k, k) = 0.1;  // elsewhere, and aslant: no matter
  s.evidence[4].covariance = upper_triangle(c);
  CadOptions options;
  options.scale_by = "circle:4=10";
  EXPECT_NEAR(known_scale(options, s, 0, {}).sigma_relative, 2 * 4e-4 / 1.0, 2e-6);
  // The same of an arc, from its three points.
  s.evidence[6].covariance = upper_triangle(1e-6 * Eigen::MatrixXd::Identity(9, 9));
  options.scale_by = "arc:6=10";
  const double sigma = known_scale(options, s, 0, {}).sigma_relative;
  EXPECT_GT(sigma, 0.3e-3);
  EXPECT_LT(sigma, 3e-3);
}

TEST(KnownScale, TagsOfOneSizeAreAveragedAndOthersRefused) {
  const std::vector<TagSquare> tags = {tag(3, 0.1, 1e-5), tag(8, 0.10001, 1e-5),
                                       tag(9, 0.2, 1e-5)};
  const KnownScale one = scaled("tag:9=20", LengthUnit::kMillimetre, tags);
  EXPECT_DOUBLE_EQ(one.units_per_world, 100);
  EXPECT_DOUBLE_EQ(one.sigma_relative, 5e-5);
  EXPECT_EQ(one.tags.size(), 1u);
  const KnownScale two = scaled("tag=10", LengthUnit::kMillimetre, {tags[0], tags[1]});
  EXPECT_NEAR(two.units_per_world, 10 / 0.100005, 1e-9);
  EXPECT_THROW(scaled("tag=10", LengthUnit::kMillimetre, tags), InputError);
  try {
    scaled("tag:4=10", LengthUnit::kMillimetre, tags);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("found tags 3 8 9"));
  }
}

TEST(KnownScale, WhatIsNotThereIsNamed) {
  for (const char* by : {"circle:0=5", "line:4=5", "line:99=5", "nodes:0-77=5", "arc:1=5"})
    EXPECT_THROW(scaled(by), InputError) << by;
  Sketch lines = part();
  lines = keep_strokes(lines, {true, true, true, true, false, false, true});
  CadOptions options;
  options.scale_by = "diameter=5";
  EXPECT_THROW(known_scale(options, lines, 0, {}), InputError);
}

TEST(KnownScale, NonsenseIsRefused) {
  for (const char* by : {"",          "tag",         "tag=",       "tag=x",        "tag=-1",
                         "tag=0",     "tag:=5",      "tag:x=5",    "tag=5furlong", "line=5",
                         "nodes:1=5", "nodes:1-1=5", "nodes:1-=5", "size:1=5",     "hole=5",
                         "=5",        ":=",          "tag=inf",    "circle:-1=5",  "circle:1-2=5",
                         "tag=5mm6"})
    EXPECT_THROW(parse_scale_reference(by), UsageError) << by;
  CadOptions both;
  both.scale_by = "size=5";
  both.scale_given = true;
  EXPECT_THROW(check_scale(both), UsageError);
}

TEST(KnownScale, WithoutAWordNobodyKnowsIt) {
  const KnownScale none = known_scale({}, part(), 1e-3, {});
  EXPECT_TRUE(none.source.empty());
  EXPECT_EQ(none.units_per_world, 1);
  CadOptions given;
  given.scale = 50, given.scale_given = true;
  const KnownScale fifty = known_scale(given, part(), 1e-3, {});
  EXPECT_EQ(fifty.source, "--scale");
  const auto json = nlohmann::json::parse(scale_json(fifty));
  EXPECT_EQ(json["world_per_unit"], 0.02);
  EXPECT_TRUE(json["sigma_relative"].is_null());
}

}  // namespace
}  // namespace sketchsplat
