// SPDX-License-Identifier: MIT
#include "datasets/types/triangulate.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "datasets/types/dense.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

const Vector3d kPoint(0.2, -0.1, 0.3);

// Side by side along x, `apart` from each to the next, and looking along z.
std::vector<View> cameras(int count, double apart) {
  std::vector<View> views(count);
  for (int k = 0; k < count; ++k) {
    views[k].camera = {400, 300, 500, 510, 200, 150};
    views[k].cam_from_world.rotation.setIdentity();
    views[k].cam_from_world.translation = Vector3d((k - 0.5 * (count - 1)) * -apart, 0, 5);
    views[k].lens = Lens(LensModel::kOpencv, {-0.2, 0.03, 0.001, -0.002});
  }
  return views;
}

std::vector<PointSight> sights_of(const std::vector<View>& views) {
  std::vector<PointSight> sights;
  for (int k = 0; k < int(views.size()); ++k) {
    double depth;
    PointSight sight{k, {}};
    EXPECT_TRUE(views[k].image_pixel(views[k].project(kPoint, &depth), &sight.pixel));
    sights.push_back(sight);
  }
  return sights;
}

TEST(Triangulate, ThePointComesBackFromAFarStart) {
  const std::vector<View> views = cameras(4, 0.7);
  Vector3d point(-0.4, 0.5, -1);
  ASSERT_TRUE(triangulate(views, sights_of(views), &point));
  EXPECT_LT((point - kPoint).norm(), 1e-6);
}

TEST(Triangulate, InformationIsTheCurvatureOfTheSquaredDistances) {
  const std::vector<View> views = cameras(4, 0.7);
  const std::vector<PointSight> sights = sights_of(views);
  const auto cost = [&](const Vector3d& at) {
    double sum = 0, depth;
    for (const PointSight& s : sights)
      sum +=
          (views[s.view].project(at, &depth) - views[s.view].project(kPoint, &depth)).squaredNorm();
    return sum;
  };
  Vector3d point = kPoint;
  Matrix3d information;
  ASSERT_TRUE(triangulate(views, sights, &point, &information));
  for (int k = 0; k < 3; ++k) {
    const Vector3d by = 1e-4 * Vector3d::Unit(k);
    EXPECT_NEAR((cost(kPoint + by) + cost(kPoint - by)) / 2e-8 / information(k, k), 1, 1e-4) << k;
  }
}

TEST(Triangulate, LinesOfSightThatAreOneTellNoDepth) {
  const std::vector<View> views = cameras(2, 0);
  Vector3d point = kPoint;
  Matrix3d information;
  triangulate(views, sights_of(views), &point, &information);
  const Vector3d values = eigenvalues_symmetric(information);
  EXPECT_LT(std::abs(values[0]), 1e-9 * values[2]);
}

TEST(Triangulate, RefusesWhatLiesBehindOrHasNoPixel) {
  const std::vector<View> views = cameras(3, 0.7);
  std::vector<PointSight> sights = sights_of(views);
  Vector3d behind(0, 0, -9);
  EXPECT_FALSE(triangulate(views, sights, &behind));
  sights[1].pixel.setConstant(NAN);
  Vector3d point = kPoint;
  EXPECT_FALSE(triangulate(views, sights, &point));
}

}  // namespace
}  // namespace sketchsplat
