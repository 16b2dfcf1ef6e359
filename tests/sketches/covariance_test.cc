// SPDX-License-Identifier: MIT
#include "sketches/solve/covariance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "sketches/curve/curve.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

// Every sample is seen by `views` views, each of which measures one direction, exactly `off` away
// to alternating sides. 100 px a world unit.
std::vector<Sighting> sightings_of(const SampleLayout& layout, int views, double off,
                                   bool one_plane = false) {
  std::vector<Sighting> out;
  for (int i = 0; i < layout.size(); ++i)
    for (int v = 0; v < views; ++v) {
      const double a = one_plane ? 0.3 : 2.4 * v + 0.3, b = 0.7 * v;
      Vector3d d(std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b));
      if (one_plane) d = Vector3d(0, 1, 0);
      out.push_back({i, v, i, 100 * d, (i + v) % 2 ? off : -off});
    }
  return out;
}

CovarianceOptions wide() {
  CovarianceOptions options;
  options.reach_px = 1e3;  // all weights one
  return options;
}

Sketch line(const Vector3d& a, const Vector3d& b) {
  Sketch s;
  const int begin = s.add_node(a), end = s.add_node(b);
  s.add_stroke(StrokeKind::kLine, begin, end, {});
  return s;
}

// A line along x, seen by two views that measure y and z: the closed form of linear regression.
TEST(Covariance, OfALineIsThatOfLinearRegression) {
  const Sketch s = line({0, 0, 0}, {1, 0, 0});
  const SampleLayout layout = plan_samples(s, 0.01);
  std::vector<Sighting> seen;
  for (int i = 0; i < layout.size(); ++i)
    for (int v = 0; v < 2; ++v)
      seen.push_back({i, v, i, 100 * Vector3d::Unit(1 + v), i % 2 ? 0.2 : -0.2});
  const StrokeCovariance c = stroke_covariances(s, layout, seen, wide())[0];
  EXPECT_EQ(c.determined, 4);
  ASSERT_EQ(c.matrix.rows(), 6);
  // Variance of an end of a regression line over n places: 4 sigma^2 / n.
  const double expected = 4 * std::pow(0.2 / 100, 2) / layout.size();
  for (int k : {1, 2, 4, 5}) EXPECT_NEAR(c.matrix(k, k), expected, 0.03 * expected) << k;
  EXPECT_NEAR(c.matrix(1, 4), -0.5 * expected, 0.04 * expected) << "ends move against each other";
  EXPECT_NEAR(c.sigma, std::sqrt(expected), 0.03 * std::sqrt(expected));
}

TEST(Covariance, HasTheRankOfTheShapeAndHoldsWhatOnlySlides) {
  Sketch s = line({0, 0, 0}, {1, 0.1, 0.2});
  const int a = s.add_node({0, 1, 0}), b = s.add_node({1, 1, 0});
  s.add_stroke(StrokeKind::kArc, a, b, {{0.5, 1.4, 0.1}});
  s.add_stroke(StrokeKind::kCircle, -1, -1, {{0, 0, 1}, {0.1, 0.2, 0.4}});
  s.add_stroke(StrokeKind::kEllipse, -1, -1, {{0, 0, 2}, {0.5, 0, 0.1}, {0, 0.3, 0}});
  const int c = s.add_node({0, 3, 0}), d = s.add_node({1, 3, 0.5});
  s.add_stroke(StrokeKind::kBezier, c, d, {{0.2, 3.9, 0}, {0.9, 2.1, 0.9}});
  const SampleLayout layout = plan_samples(s, 0.05);
  const auto all = stroke_covariances(s, layout, sightings_of(layout, 7, 0.2), wide());
  const int expected[] = {4, 6, 6, 8, 10}, controls[] = {2, 3, 2, 3, 4};
  for (int i = 0; i < s.size(); ++i) {
    EXPECT_EQ(all[i].determined, expected[i]) << kind_name(s.strokes[i].kind);
    EXPECT_EQ(all[i].matrix.rows(), 3 * controls[i]);
    EXPECT_GT(all[i].sigma, 0);
  }
  const Vector3d along = Vector3d(1, 0.1, 0.2).normalized();
  EXPECT_LT(along.dot(all[0].matrix.topLeftCorner<3, 3>() * along), 1e-6 * all[0].matrix.trace());
  EXPECT_LT(all[1].matrix.row(3).norm(), 1e-6 * all[1].matrix.norm())
      << "the apex of an arc along its chord";
}

TEST(Covariance, DepthThatNoViewMeasuresIsNotDetermined) {
  const Sketch s = line({0, 0, 0}, {1, 0, 0});
  const SampleLayout layout = plan_samples(s, 0.05);
  const auto all =
      stroke_covariances(s, layout, sightings_of(layout, 7, 0.2, /*one_plane=*/true), wide());
  EXPECT_EQ(all[0].determined, 2);
}

// What a view's sightings have in common does not average out along a stroke.
TEST(Covariance, ErrorsOfWholeViewsCount) {
  const Sketch s = line({0, 0, 0}, {1, 0, 0});
  const SampleLayout layout = plan_samples(s, 0.01);
  std::vector<Sighting> seen = sightings_of(layout, 12, 0.1), biased = seen;
  for (Sighting& b : biased) b.distance_px = b.view % 2 ? 0.1 : -0.1;  // the same scatter
  const double single = stroke_covariances(s, layout, seen, wide())[0].sigma;
  const double whole = stroke_covariances(s, layout, biased, wide())[0].sigma;
  EXPECT_GT(whole, 3 * single);
  // Twelve views of +-0.1 px over a few directions tell no more than a tenth of a pixel.
  EXPECT_GT(whole, 0.1 / 100 / std::sqrt(12.0));
  EXPECT_LT(whole, 0.1 / 100);
}

TEST(Covariance, AnEdgelThatManySamplesFindErrsOnce) {
  const Sketch s = line({0, 0, 0}, {1, 0, 0});
  const SampleLayout coarse = plan_samples(s, 0.05), fine = plan_samples(s, 0.0125);
  std::mt19937 random(3);
  std::normal_distribution<double> error(0, 0.2);
  std::vector<Sighting> once, often;
  for (int v = 0; v < 8; ++v)
    for (int i = 0; i < coarse.size(); ++i)
      once.push_back(
          {i, v, i, 100 * Vector3d(0, std::cos(2.4 * v), std::sin(2.4 * v)), error(random)});
  std::stable_sort(once.begin(), once.end(),
                   [](const Sighting& a, const Sighting& b) { return a.sample < b.sample; });
  for (int k = 0; k < fine.size(); ++k)
    for (const Sighting& m : once)
      if (m.sample == k / 4) often.push_back({k, m.view, m.edgel, m.direction, m.distance_px});
  const double a = stroke_covariances(s, coarse, once, wide())[0].sigma;
  const double b = stroke_covariances(s, fine, often, wide())[0].sigma;
  EXPECT_NEAR(b, a, 0.1 * a);
}

TEST(Covariance, WhatNobodySeesHasNone) {
  const Sketch s = line({0, 0, 0}, {1, 0, 0});
  const SampleLayout layout = plan_samples(s, 0.1);
  const auto all = stroke_covariances(s, layout, {}, {});
  EXPECT_EQ(all[0].determined, 0);
  EXPECT_EQ(all[0].sigma, 0);
  EXPECT_EQ(all[0].matrix.size(), 0);
  EXPECT_TRUE(stroke_covariances(Sketch(), plan_samples(Sketch(), 1), {}, {}).empty());
}

TEST(Covariance, ScalesWithTheUnit) {
  Sketch s = line({0, 0, 0}, {1, 0.1, 0});
  const SampleLayout layout = plan_samples(s, 0.02);
  std::vector<Sighting> seen = sightings_of(layout, 6, 0.2);
  const StrokeCovariance one = stroke_covariances(s, layout, seen, {})[0];
  s.nodes *= 1000;
  for (Sighting& m : seen) m.direction /= 1000;
  const StrokeCovariance other = stroke_covariances(s, layout, seen, {})[0];
  EXPECT_NEAR(other.sigma, 1000 * one.sigma, 1e-6 * other.sigma);
  EXPECT_NEAR(other.matrix(1, 1), 1e6 * one.matrix(1, 1), 1e-6 * other.matrix(1, 1));
  EXPECT_EQ(other.determined, one.determined);
}

TEST(Covariance, UpperTriangleComesBack) {
  MatrixXd m = MatrixXd::Random(6, 6);
  m = (m + m.transpose()).eval();
  EXPECT_EQ(upper_triangle(m).size(), 21u);
  EXPECT_EQ(from_upper_triangle(upper_triangle(m)), m);
  EXPECT_EQ(from_upper_triangle({}).size(), 0);
}

}  // namespace
}  // namespace sketchsplat
