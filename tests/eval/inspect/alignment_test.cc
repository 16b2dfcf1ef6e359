// SPDX-License-Identifier: MIT
#include "eval/inspect/alignment.h"

#include <gtest/gtest.h>

#include <cmath>

#include "datasets/types/errors.h"
#include "tests/eval/inspect/plate.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;

// Largest distance from where it belongs of a corner that the pose brings back.
double miss(const Alignment& a, const Similarity& away, const Sketch& part) {
  double largest = 0;
  for (int i = 0; i < part.nodes.cols(); ++i)
    largest = std::max(largest, (a.pose * (away * part.nodes.col(i)) - part.nodes.col(i)).norm());
  return largest;
}

TEST(Align, FindsAPartThatLiesAnywhere) {
  const Nominal nominal = make_nominal(plate(), "plate");
  for (int k = 0; k < 8; ++k) {
    const Similarity away = {1, rotation_about({1.1 * k, 0.5 - k, 2.0}), {k * 50.0, 7, -k * 3.0}};
    const Alignment a = align(moved(plate(), away), nominal, {});
    EXPECT_LT(miss(a, away, plate()), 1e-6) << k;
    EXPECT_EQ(a.equal_poses, 1);
    EXPECT_EQ(a.free_directions, 0);
    EXPECT_GT(a.share, 0.999);
    EXPECT_GT(a.runner_up, 1.5);
  }
}

TEST(Align, EdgesThatAreMissingDoNotMatter) {
  const Sketch part = plate();
  const Nominal nominal = make_nominal(part, "plate");
  std::vector<bool> keep(part.size(), true);
  for (const int lost : {0, 3, 5, 6, 9, 10, 14, 16}) keep[lost] = false;
  const Similarity away = elsewhere();
  const Alignment a = align(moved(keep_strokes(part, keep), away), nominal, {});
  EXPECT_LT(miss(a, away, part), 1e-6);
}

TEST(Align, AHoleInTheWrongPlaceHasNoSay) {
  Sketch part = plate();
  const Nominal nominal = make_nominal(part, "plate");
  for (const int s : {12, 13}) part.handles.col(part.strokes[s].handle) += Vector3d(0.4, 0.3, 0);
  const Similarity away = elsewhere();
  const Alignment a = align(moved(part, away), nominal, {});
  EXPECT_LT(miss(a, away, plate()), 1e-6);
  EXPECT_FALSE(a.holds[12]);
  EXPECT_FALSE(a.holds[13]);
  EXPECT_TRUE(a.holds[0]);
}

TEST(Align, SymmetricPartsStayAsTheyStandAndTheUserIsTold) {
  const Sketch part = box({100, 60, 10});
  const Similarity away = {1, rotation_about({0, 0, 0.6}), {5, 5, 5}};
  const Alignment a = align(moved(part, away), make_nominal(part, "box"), {});
  EXPECT_EQ(a.equal_poses, 4);
  EXPECT_LT(miss(a, away, part), 1e-6);
}

TEST(Align, ATurnedPartMaySpin) {
  Sketch part;
  for (const double z : {0.0, 30.0, 50.0})
    part.add_stroke(StrokeKind::kCircle, -1, -1, {{0, 0, z}, {0, 0, 10 + z / 10}});
  const Similarity away = elsewhere();
  const Alignment a = align(moved(part, away), make_nominal(part, "shaft"), {});
  EXPECT_EQ(a.free_directions, 1);
  EXPECT_LT((a.pose * (away * Vector3d(0, 0, 50)) - Vector3d(0, 0, 50)).norm(), 1e-6);
  EXPECT_LT((a.pose * (away * Vector3d(0, 0, 0)) - Vector3d(0, 0, 0)).norm(), 1e-6);
}

TEST(Align, FitsAScaleOnlyIfItIsAskedTo) {
  const Nominal nominal = make_nominal(plate(), "plate");
  Similarity away = elsewhere();
  away.scale = 0.0125;
  AlignOptions options;
  options.fit_scale = true;
  const Alignment a = align(moved(plate(), away), nominal, options);
  EXPECT_NEAR(a.pose.scale, 80, 1e-6);
  EXPECT_LT(miss(a, away, plate()), 1e-6);
  away.scale = 1.004;
  const Alignment b = align(moved(plate(), away), nominal, {});
  EXPECT_EQ(b.pose.scale, 1);
  EXPECT_GT(b.rms, 0.01);
}

// One side of the part is 0.2 too far out. By the best fit that is spread; by datums it is not.
TEST(Align, DatumsHoldThePoseInTheirOrder) {
  const Nominal nominal = make_nominal(box({100, 60, 10}), "box");
  Sketch part = box({100, 60, 10});
  for (int i = 0; i < 8; ++i)
    if (i & 1) part.nodes(0, i) += 0.2;
  const auto plane_at = [&](const Vector3d& point) {
    for (const NominalPlane& p : nominal.planes)
      if (std::abs((point - p.point).dot(p.normal)) < 1e-6) return p.name;
    return std::string();
  };
  AlignOptions options;
  options.datums = {plane_at({50, 30, 0}), plane_at({0, 30, 5}), plane_at({50, 0, 5})};
  const Alignment a = align(part, nominal, options);
  EXPECT_LT((a.pose * Vector3d(0, 0, 0)).norm(), 1e-6);
  EXPECT_LT((a.pose * Vector3d(0, 60, 10) - Vector3d(0, 60, 10)).norm(), 1e-6);
  options.datums = {plane_at({50, 30, 0}), plane_at({100, 30, 5}), plane_at({50, 0, 5})};
  const Alignment b = align(part, nominal, options);
  EXPECT_LT((b.pose * Vector3d(100.2, 0, 0) - Vector3d(100, 0, 0)).norm(), 1e-6);
  options.datums = {"E99"};
  EXPECT_THROW(align(part, nominal, options), InputError);
}

TEST(Align, ErrorsOfThePoseFollowFromThoseOfTheStrokes) {
  const Sketch part = with_sigma(plate(), 0.02);
  const Nominal nominal = make_nominal(plate(), "plate");
  std::mt19937 random(3);
  Vector3d squares = Vector3d::Zero(), foretold = Vector3d::Zero();
  constexpr int kDraws = 60;
  for (int i = 0; i < kDraws; ++i) {
    const Alignment a = align(noisy(part, 0.02, &random), nominal, {});
    squares += (a.pose * a.centre - a.centre).cwiseAbs2() / kDraws;
    foretold += a.covariance.diagonal().tail<3>() / kDraws;
  }
  for (int k = 0; k < 3; ++k) {
    EXPECT_LT(std::sqrt(squares[k]), 1.4 * std::sqrt(foretold[k])) << k;
    EXPECT_GT(std::sqrt(squares[k]), 0.6 * std::sqrt(foretold[k])) << k;
  }
}

}  // namespace
}  // namespace sketchsplat
