// SPDX-License-Identifier: MIT
#include "edges/surfel_planes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "edges/surfel_shading.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;
constexpr double kSpacing = 0.05;
constexpr int kSide = 24;

// A grid of surfels on a surface given by its points and normals, with errors as fits have them:
// 5 % of the spacing and 1.5 deg about each axis.
SurfelSet noisy(const std::function<void(double, double, Vector3d*, Vector3d*)>& surface) {
  std::mt19937 random(7);
  std::normal_distribution<double> error;
  SurfelSet set;
  set.values = Eigen::MatrixXd::Zero(SurfelSet::kRows, kSide * kSide);
  for (int i = 0; i < set.size(); ++i) {
    Vector3d p, n;
    surface(kSpacing * (i % kSide), kSpacing * (i / kSide), &p, &n);
    const Vector3d tilt(error(random), error(random), error(random));
    set.values.col(i).segment<3>(SurfelSet::kCenter) = p + 0.05 * kSpacing * error(random) * n;
    set.values.col(i).segment<4>(SurfelSet::kRotation) =
        rotation_to((n + 0.02 * tilt).normalized());
  }
  return set;
}

Vector3d normal_of(const SurfelSet& set, int i) {
  return surfel_normal(set.values.col(i).segment<4>(SurfelSet::kRotation));
}

TEST(SurfelPlanes, ANoisyPlaneBecomesOneExactPlane) {
  SurfelSet set = noisy([](double x, double y, Vector3d* p, Vector3d* n) {
    *p = Vector3d(x, y, 0), *n = Vector3d::UnitZ();
  });
  const SurfelSet before = set;
  EXPECT_EQ(flatten_surfels(kSpacing, {}, &set), set.size());
  for (int i = 0; i < set.size(); ++i) {
    EXPECT_NEAR((normal_of(set, i) - normal_of(set, 0)).norm(), 0, 1e-9);
    const Vector3d d = set.values.col(i).head<3>() - set.values.col(0).head<3>();
    EXPECT_NEAR(d.dot(normal_of(set, 0)), 0, 1e-9);
  }
  EXPECT_LT(std::acos(normal_of(set, 0).z()) * 180 / M_PI, 0.2);
  EXPECT_EQ(set.values.bottomRows(SurfelSet::kRows - SurfelSet::kLogScale),
            before.values.bottomRows(SurfelSet::kRows - SurfelSet::kLogScale));
}

TEST(SurfelPlanes, TheTwoSidesOfAnEdgeBecomeTwoPlanes) {
  const double fold = 0.5 * kSpacing * (kSide - 1), slope = std::tan(20 * M_PI / 180);
  SurfelSet set = noisy([&](double x, double y, Vector3d* p, Vector3d* n) {
    const double s = x < fold ? slope : -slope;
    *p = Vector3d(x, y, s * (x - fold)), *n = Vector3d(-s, 0, 1).normalized();
  });
  EXPECT_GT(flatten_surfels(kSpacing, {}, &set), set.size() * 9 / 10);
  const int left = 2 + 12 * kSide, right = kSide - 3 + 12 * kSide;
  EXPECT_NEAR(std::acos(normal_of(set, left).dot(normal_of(set, right))) * 180 / M_PI, 40, 0.5);
}

TEST(SurfelPlanes, ARoundSurfaceGetsNoFacets) {
  for (const double radius : {0.3, 0.6, 1.5}) {  // of 12 deg to 2 deg per spacing
    SurfelSet set = noisy([&](double x, double y, Vector3d* p, Vector3d* n) {
      *n = Vector3d(std::sin(x / radius), 0, std::cos(x / radius));
      *p = radius * *n + Vector3d(0, y, 0);
    });
    EXPECT_LT(flatten_surfels(kSpacing, {}, &set), set.size() / 10) << radius;
  }
}

TEST(SurfelPlanes, FewSurfelsAndNoneStayAsTheyAre) {
  SurfelSet set = noisy([](double x, double y, Vector3d* p, Vector3d* n) {
    *p = Vector3d(x, y, 0), *n = Vector3d::UnitZ();
  });
  set.values.conservativeResize(Eigen::NoChange, 20);
  const Eigen::MatrixXd before = set.values;
  EXPECT_EQ(flatten_surfels(kSpacing, {}, &set), 0);
  EXPECT_EQ(set.values, before);
  set.values.conservativeResize(Eigen::NoChange, 0);
  EXPECT_EQ(flatten_surfels(kSpacing, {}, &set), 0);
}

}  // namespace
}  // namespace sketchsplat
