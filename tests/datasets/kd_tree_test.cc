// SPDX-License-Identifier: MIT
#include "datasets/neighbours/kd_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace sketchsplat {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// Points in a flat box, every tenth one twice.
Matrix3Xd some_points(int n) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> in(-1, 1);
  Matrix3Xd points(3, n);
  for (int i = 0; i < n; ++i)
    points.col(i) = i % 10 == 1 ? Vector3d(points.col(i - 1))
                                : Vector3d(in(random), in(random), in(random) / 9);
  return points;
}

TEST(KdTree, FindsWhatASearchOfAllPointsFinds) {
  const Matrix3Xd points = some_points(1200), places = 1.5 * some_points(301);
  const KdTree tree(points);
  size_t found = 0;
  for (int k = 0; k < places.cols(); ++k) {
    const Vector3d place = places.col(k);
    const double radius = 0.4 * (k % 7) / 6;
    double nearest = INFINITY;
    std::vector<int> within;
    for (int i = 0; i < points.cols(); ++i) {
      const double distance = (points.col(i) - place).norm();
      nearest = std::min(nearest, distance);
      if (distance < radius) within.push_back(i);
    }
    EXPECT_NEAR(tree.distance(place), nearest, 1e-15) << k;
    EXPECT_EQ(tree.within(place, radius), within) << k;
    found += within.size();
  }
  EXPECT_GT(found, 1000u);
}

TEST(KdTree, NoPointIsInfinitelyFar) {
  const KdTree tree(Matrix3Xd(3, 0));
  EXPECT_EQ(tree.distance(Vector3d::Zero()), INFINITY);
  EXPECT_TRUE(tree.within(Vector3d::Zero(), 1).empty());
}

TEST(KdTree, ManyPointsInOnePlaceAreAllFound) {
  const KdTree tree(Matrix3Xd::Ones(3, 5000));
  EXPECT_EQ(tree.within(Vector3d::Ones(), 1e-9).size(), 5000u);
  EXPECT_EQ(tree.distance(Vector3d(1, 1, 3)), 2);
}

}  // namespace
}  // namespace sketchsplat
