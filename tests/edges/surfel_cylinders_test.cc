// SPDX-License-Identifier: MIT
#include "edges/surfels/fit/surfel_cylinders.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "noisy_surfels.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

// A part of a cylinder about the z axis, `side` +1: seen from outside.
SurfelSet cylinder(double radius, double side) {
  return noisy([=](double x, double y, Vector3d* p, Vector3d* n) {
    const Vector3d away(std::cos(x / radius), std::sin(x / radius), 0);
    *p = radius * away + Vector3d(0, 0, y), *n = side * away;
  });
}

int round_all(SurfelSet* set) {
  return round_surfels(kSpacing, {}, std::vector<char>(set->size(), 0), set);
}

TEST(SurfelCylinders, NoisyCylindersBecomeExactOnesInsideAndOutside) {
  for (const double side : {1.0, -1.0})
    for (const double radius : {0.1, 0.19, 0.3, 0.6}) {  // turns of 690, 360, 230 and 115 deg
      SurfelSet set = cylinder(radius, side);
      const SurfelSet before = set;
      ASSERT_GT(round_all(&set), set.size() * 97 / 100) << radius;
      Vector3d axis = Vector3d::Zero();
      for (int i = 1; i < set.size(); ++i) {
        Vector3d a = set.normal(0).cross(set.normal(i));
        if (a.norm() > 0.5) axis += a.z() < 0 ? Vector3d(-a) : a;
      }
      axis.normalize();
      EXPECT_LT(std::acos(axis.z()) * 180 / M_PI, 0.5) << radius;
      double off = 0, lean = 0;
      for (int i = 0; i < set.size(); ++i) {
        const Vector3d p = set.center(i);
        off += std::abs(p.head<2>().norm() - radius) / set.size();
        lean += std::acos(std::min(
                    1.0, side * set.normal(i).dot(Vector3d(p.x(), p.y(), 0).normalized()))) /
                set.size();
      }
      EXPECT_LT(off, 0.02 * kSpacing) << radius;
      EXPECT_LT(lean * 180 / M_PI, 0.5) << radius;
      EXPECT_EQ(set.values.bottomRows(SurfelSet::kRows - SurfelSet::kLogScale),
                before.values.bottomRows(SurfelSet::kRows - SurfelSet::kLogScale));
    }
}

TEST(SurfelCylinders, PlanesConesSpheresAndRingsStayAsTheyAre) {
  const auto plane = [](double x, double y, Vector3d* p, Vector3d* n) {
    *p = Vector3d(x, y, 0), *n = Vector3d::UnitZ();
  };
  const auto cone = [](double x, double y, Vector3d* p, Vector3d* n) {  // of 20 deg
    const double tilt = 20 * M_PI / 180, radius = 0.2 + y * std::sin(tilt), a = x / 0.2;
    *p = Vector3d(radius * std::cos(a), radius * std::sin(a), y * std::cos(tilt));
    *n = Vector3d(std::cos(a) * std::cos(tilt), std::sin(a) * std::cos(tilt), -std::sin(tilt));
  };
  const auto sphere = [](double x, double y, Vector3d* p, Vector3d* n) {
    const double a = x / 0.4, b = (y - 0.6) / 0.4;
    *n = Vector3d(std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b));
    *p = 0.4 * *n;
  };
  const auto ring = [](double x, double y, Vector3d* p, Vector3d* n) {  // an elbow of a pipe
    const double a = x / 0.2, b = y / 0.8;
    const Vector3d out(std::cos(b), std::sin(b), 0);
    *n = std::cos(a) * out + std::sin(a) * Vector3d::UnitZ();
    *p = 0.8 * out + 0.2 * *n;
  };
  const std::function<void(double, double, Vector3d*, Vector3d*)> all[] = {plane, cone, sphere,
                                                                           ring};
  for (int k = 0; k < 4; ++k) {
    SurfelSet set = noisy(all[k]);
    EXPECT_LT(round_all(&set), set.size() / 6) << k;  // narrow strips may
  }
}

TEST(SurfelCylinders, SurfelsThatAreTakenStay) {
  SurfelSet set = cylinder(0.3, 1);
  const SurfelSet before = set;
  std::vector<char> taken(set.size(), 0);
  for (int i = 0; i < set.size(); i += 3) taken[i] = 1;
  EXPECT_GT(round_surfels(kSpacing, {}, taken, &set), set.size() * 6 / 10);
  for (int i = 0; i < set.size(); i += 3) EXPECT_EQ(set.values.col(i), before.values.col(i));
}

TEST(SurfelCylinders, FewSurfelsAndNoneStayAsTheyAre) {
  SurfelSet set = cylinder(0.1, 1);
  set.values.conservativeResize(Eigen::NoChange, 30);
  const Eigen::MatrixXd before = set.values;
  EXPECT_EQ(round_all(&set), 0);
  EXPECT_EQ(set.values, before);
  set.values.conservativeResize(Eigen::NoChange, 0);
  EXPECT_EQ(round_all(&set), 0);
}

TEST(SurfelCylinders, TheSameSurfelsGiveTheSameResult) {
  SurfelSet one = cylinder(0.3, -1), two = one;
  round_all(&one), round_all(&two);
  EXPECT_EQ(one.values, two.values);
}

}  // namespace
}  // namespace sketchsplat
