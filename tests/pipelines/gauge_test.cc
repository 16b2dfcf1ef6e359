// SPDX-License-Identifier: MIT
#include "pipelines/cameras/gauge.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "tests/support/wireframe.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;

const Vector3d kMiddle(0.4, -0.2, 1.1);
constexpr double kDistance = 4, kRadius = 0.5;  // of cameras from the object; of the object

std::vector<View> cameras(int count) { return ring_of_views(count, kMiddle, kDistance); }

std::vector<double> radii(const std::vector<View>& views) {
  return std::vector<double>(views.size(), views[0].camera.fx * kRadius / kDistance);
}

// How poses err [px]: turns of cameras about themselves or about the object, and shifts.
struct Errors {
  double turn = 0, shift = 0;
  bool about_object = false;
};

std::vector<View> with_errors(std::vector<View> views, const Errors& how, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto draw = [&]() -> Vector3d {
    const double x = normal(random), y = normal(random), z = normal(random);
    return {x, y, z};
  };
  for (View& v : views) {
    Pose& pose = v.cam_from_world;
    const Vector3d at = pose * kMiddle;
    const Eigen::Matrix3d turn = rotation_about(how.turn / v.camera.fx * draw());
    pose.rotation = turn * pose.rotation;
    const Vector3d pivot = how.about_object ? at : Vector3d::Zero();
    pose.translation = turn * (pose.translation - pivot) + pivot;
    pose.translation += how.shift * kDistance / v.camera.fx * draw();
  }
  return views;
}

// Root mean square displacement [px] of points of the object by what a gauge leaves.
double off_px(const std::vector<View>& found, const std::vector<View>& stated,
              const Similarity& true_from_found) {
  const Similarity left =
      likeliest_gauge(found, stated, true_from_found.inverse() * kMiddle, radii(found)) *
      true_from_found.inverse();
  double sum = 0;
  for (int k = 0; k < 6; ++k) {
    Vector3d p = kMiddle;
    p[k / 2] += k % 2 ? kRadius : -kRadius;
    sum += (left * p - p).squaredNorm() / 6;
  }
  return std::sqrt(sum) * found[0].camera.fx / kDistance;
}

const Similarity kAway = {1.004, rotation_about({0.003, -0.006, 0.004}), {0.01, 0.02, -0.015}};

std::vector<View> moved(std::vector<View> views, const Similarity& by) {
  for (View& v : views) v = sketchsplat::moved(std::move(v), by);
  return views;
}

TEST(Gauge, AMovedViewSeesTheMovedPointWhereItSawThePoint) {
  const Similarity to = {2.5, rotation_about({0.7, -1.9, 0.4}), {3, -2, 5}};
  const View view = cameras(5)[2], there = sketchsplat::moved(view, to);
  const Vector3d p = kMiddle + Vector3d(0.1, 0.3, -0.2);
  double depth, other;
  EXPECT_LT((view.project(p, &depth) - there.project(to * p, &other)).norm(), 1e-9);
  EXPECT_NEAR(other, 2.5 * depth, 1e-12);
}

TEST(Gauge, WhereStatedPosesAreRightEverythingComesBack) {
  const std::vector<View> truth = cameras(12);
  EXPECT_LT(off_px(moved(truth, kAway.inverse()), truth, kAway), 1e-4);
  EXPECT_LT(off_px(truth, truth, {}), 1e-9);
}

TEST(Gauge, CentresHoldItWhereCamerasTurnAndTheObjectWherePosesAreOfImagesOfIt) {
  const std::vector<View> truth = cameras(24);
  for (const bool about_object : {false, true}) {
    const Errors turns = {2, 0, about_object};
    // What is left of turns about the object is their mean: 2 px * 0.125 / sqrt(24) on its rim.
    EXPECT_LT(off_px(truth, with_errors(truth, turns, 1), {}), about_object ? 0.2 : 0.02);
  }
}

TEST(Gauge, ItDoesNotMatterWhereTheWorldWasFound) {
  const std::vector<View> truth = cameras(24), stated = with_errors(truth, {1, 1, false}, 3);
  const Similarity one = likeliest_gauge(truth, stated, kMiddle, radii(truth));
  const Similarity other =
      likeliest_gauge(moved(truth, kAway), stated, kAway * kMiddle, radii(truth)) * kAway;
  for (const Vector3d& p : {kMiddle, Vector3d(kMiddle + Vector3d(0.5, -0.3, 0.2))})
    EXPECT_LT((one * p - other * p).norm(), 1e-5);
}

// The mean of what views say of the middle would be off by 1.4 px / sqrt(16) along each of three
// axes.
TEST(Gauge, IndependentTurnsAndShiftsLeaveLessThanTheirMean) {
  const std::vector<View> truth = cameras(24);
  double sum = 0;
  constexpr int kSeeds = 40;
  for (int seed = 0; seed < kSeeds; ++seed)
    sum += std::pow(off_px(truth, with_errors(truth, {1, 1, false}, seed), {}), 2) / kSeeds;
  EXPECT_LT(std::sqrt(sum), 0.42);
}

TEST(Gauge, AViewWhoseTurnNobodyKnowsCountsForLittle) {
  std::vector<View> found = cameras(24), stated = with_errors(found, {1, 1, false}, 5);
  Pose& pose = found[7].cam_from_world;
  const Vector3d at = pose * kMiddle;
  pose.rotation = rotation_about({0.3, -0.2, 0}) * pose.rotation;
  pose.translation = at - pose.rotation * kMiddle;  // the object's middle stays where it is
  const Similarity with = likeliest_gauge(found, stated, kMiddle, radii(found));
  found.erase(found.begin() + 7), stated.erase(stated.begin() + 7);
  const Similarity without = likeliest_gauge(found, stated, kMiddle, radii(found));
  const double px = found[0].camera.fx / kDistance;
  EXPECT_LT((with * kMiddle - without * kMiddle).norm() * px, 0.15);
  EXPECT_GT((without * kMiddle - kMiddle).norm() * px, 0.1) << "what is looked for";
}

TEST(Gauge, PointsBringBackWhatOtherCamerasShowThoughSomeAreWrong) {
  const std::vector<View> truth = cameras(12);
  std::vector<ScenePoint> points;
  for (int i = 0; i < 60; ++i) {
    ScenePoint point;
    point.position = kMiddle + Vector3d(std::sin(1.7 * i), std::cos(2.9 * i), std::sin(0.8 * i));
    for (int v = i % 3; v < 12; v += 3) {
      double depth;
      point.sights.push_back({v, truth[v].project(point.position, &depth)});
    }
    if (i % 8 == 0) point.position += Vector3d(0.2, -0.1, 0.3);
    points.push_back(point);
  }
  const Similarity to = gauge_of_points(moved(truth, kAway), points);
  for (const Vector3d& p : {kMiddle, Vector3d(kMiddle + Vector3d(0.5, -0.3, 0.2))})
    EXPECT_LT((to * (kAway * p) - p).norm(), 2e-4);
  points.resize(10);
  EXPECT_EQ(gauge_of_points(moved(truth, kAway), points).scale, 1);
}

TEST(Gauge, FewViewsMoveNothing) {
  const std::vector<View> truth = cameras(5);
  const Similarity none = likeliest_gauge(moved(truth, kAway), truth, kMiddle, radii(truth));
  EXPECT_EQ(none.scale, 1);
  EXPECT_EQ(none.translation.norm(), 0);
}

}  // namespace
}  // namespace sketchsplat
