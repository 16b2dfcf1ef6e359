// SPDX-License-Identifier: MIT
#include "edges/surfels/fit/surfel_planes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "noisy_surfels.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

int count_flat(SurfelSet* set) {
  const std::vector<char> flat = flatten_surfels(kSpacing, {}, set);
  return int(std::count(flat.begin(), flat.end(), 1));
}

TEST(SurfelPlanes, ANoisyPlaneBecomesOneExactPlane) {
  SurfelSet set = noisy([](double x, double y, Vector3d* p, Vector3d* n) {
    *p = Vector3d(x, y, 0), *n = Vector3d::UnitZ();
  });
  const SurfelSet before = set;
  EXPECT_EQ(count_flat(&set), set.size());
  for (int i = 0; i < set.size(); ++i) {
    EXPECT_NEAR((set.normal(i) - set.normal(0)).norm(), 0, 1e-9);
    const Vector3d d = set.values.col(i).head<3>() - set.values.col(0).head<3>();
    EXPECT_NEAR(d.dot(set.normal(0)), 0, 1e-9);
  }
  EXPECT_LT(std::acos(set.normal(0).z()) * 180 / M_PI, 0.2);
  EXPECT_EQ(set.values.bottomRows(SurfelSet::kRows - SurfelSet::kLogScale),
            before.values.bottomRows(SurfelSet::kRows - SurfelSet::kLogScale));
}

TEST(SurfelPlanes, TheTwoSidesOfAnEdgeBecomeTwoPlanes) {
  const double fold = 0.5 * kSpacing * (kSide - 1), slope = std::tan(20 * M_PI / 180);
  SurfelSet set = noisy([&](double x, double y, Vector3d* p, Vector3d* n) {
    const double s = x < fold ? slope : -slope;
    *p = Vector3d(x, y, s * (x - fold)), *n = Vector3d(-s, 0, 1).normalized();
  });
  EXPECT_GT(count_flat(&set), set.size() * 9 / 10);
  const int left = 2 + 12 * kSide, right = kSide - 3 + 12 * kSide;
  EXPECT_NEAR(std::acos(set.normal(left).dot(set.normal(right))) * 180 / M_PI, 40, 0.5);
}

TEST(SurfelPlanes, ARoundSurfaceGetsNoFacets) {
  for (const double radius : {0.3, 0.6, 1.5, 3.0}) {  // of 10 deg to 1 deg per spacing
    SurfelSet set = noisy([&](double x, double y, Vector3d* p, Vector3d* n) {
      *n = Vector3d(std::sin(x / radius), 0, std::cos(x / radius));
      *p = radius * *n + Vector3d(0, y, 0);
    });
    EXPECT_LT(count_flat(&set), set.size() / 10) << radius;
  }
}

TEST(SurfelPlanes, FewSurfelsAndNoneStayAsTheyAre) {
  SurfelSet set = noisy([](double x, double y, Vector3d* p, Vector3d* n) {
    *p = Vector3d(x, y, 0), *n = Vector3d::UnitZ();
  });
  set.values.conservativeResize(Eigen::NoChange, 20);
  const Eigen::MatrixXd before = set.values;
  EXPECT_EQ(count_flat(&set), 0);
  EXPECT_EQ(set.values, before);
  set.values.conservativeResize(Eigen::NoChange, 0);
  EXPECT_EQ(count_flat(&set), 0);
}

}  // namespace
}  // namespace sketchsplat
