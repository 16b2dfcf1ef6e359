// SPDX-License-Identifier: MIT
#include "edges/contrast/contrast_judge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "edges/contrast/alarm_threshold.h"
#include "edges/views/unexplained.h"
#include "tests/support/painted.h"
#include "tests/support/wireframe.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kDistance = 2.5;
constexpr double kFootprint = kDistance / 500;  // of a pixel

// Ten cameras above the plane z = 0.
std::vector<View> views_from_above() {
  std::vector<View> out;
  for (const View& v : ring_of_views(34, Vector3d::Zero(), kDistance))
    if (v.center_in_world().z() > 0.4 * kDistance) out.push_back(v);
  EXPECT_EQ(out.size(), 10);
  return out;
}

// Grey levels of the plane at a place, in a view.
using Plane = std::function<double(const Vector2d& place, int view)>;

EdgeWorld painted(const Plane& plane, double noise, int seed) {
  const auto level = [&](const Vector3d& eye, const Vector3d& ray, int view) {
    const Vector3d place = eye - ray * (eye.z() / ray.z());
    return plane(place.head<2>(), view);
  };
  return test::painted(views_from_above(), kFootprint, level, noise, seed);
}

CurvePoints line(const Vector3d& a, const Vector3d& b) {
  const int n = std::max(2, int((b - a).norm() / kFootprint));
  CurvePoints out;
  out.position.resize(3, n);
  out.tangent = (b - a).normalized().replicate(1, n);
  for (int i = 0; i < n; ++i) out.position.col(i) = a + (b - a) * (i + 0.5) / n;
  out.first = {0, n};
  return out;
}

CurvePoints line_on_plane(const Vector2d& middle, double angle, double length_px) {
  const Vector3d half =
      0.5 * length_px * kFootprint * Vector3d(std::cos(angle), std::sin(angle), 0);
  const Vector3d c(middle.x(), middle.y(), 0);
  return line(c - half, c + half);
}

double slope(const Vector2d& p, int view) {
  return 120 + 60 * p.x() + 80 * p.y() * p.y() + 40 * std::sin(7 * p.x() + view);
}

ContrastJudge judge_of(const EdgeWorld& world) {
  return {world, CurvePoints(), no_edgels(world), {}};
}

// Blotches that lie on the plane in all views: sums of waves of all directions, 4 to 30 px long.
Plane blotches(int seed, double contrast) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> any(0, 2 * M_PI), wave(4, 30);
  std::vector<Eigen::Vector3d> waves;
  for (int k = 0; k < 40; ++k) {
    const double number = 2 * M_PI / (wave(rng) * kFootprint), way = any(rng);
    waves.emplace_back(number * std::cos(way), number * std::sin(way), any(rng));
  }
  return [=](const Vector2d& p, int) {
    double sum = 0;
    for (const Vector3d& w : waves) sum += std::sin(w.head<2>().dot(p) + w.z());
    return 120 + contrast * sum / std::sqrt(20.0);
  };
}

constexpr int kLines = 150;
constexpr double kRate = 0.05;  // false alarms that are tolerated among them

// The nats of lines anywhere on the plane.
std::vector<double> nats_of_lines(const EdgeWorld& world, int seed) {
  const ContrastJudge judge = judge_of(world);
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> place(-0.5, 0.5), angle(0, M_PI), length(20, 100);
  std::vector<double> out;
  for (int k = 0; k < kLines; ++k) {
    const double x = place(rng), y = place(rng), way = angle(rng);
    out.push_back(judge.judge(line_on_plane({x, y}, way, length(rng))).nats);
  }
  return out;
}

double threshold_of(const EdgeWorld& world) {
  return alarm_threshold(nats_of_lines(world, 1), kLines, kRate);
}

int alarms(const EdgeWorld& world) {
  const double least = threshold_of(world);
  int out = 0;
  for (const double nats : nats_of_lines(world, 2)) out += nats > least;
  return out;
}

const Vector2d kOrigin(0, 0);
const double kUpright = M_PI / 2;

TEST(ContrastJudge, AHundredPixelsInTenViewsAtNoiseThreeShowAStepOfOneGreyLevel) {
  int shown = 0;
  for (int seed = 1; seed <= 5; ++seed) {
    const EdgeWorld world = painted(
        [](const Vector2d& p, int v) { return slope(p, v) + (p.x() > 0 ? 1 : 0); }, 3, seed);
    const ContrastJudge judge = judge_of(world);
    shown += judge.judge(line_on_plane(kOrigin, kUpright, 100)).nats > threshold_of(world);
    EXPECT_LT(judge.judge(line_on_plane({0.04, 0}, kUpright, 100)).nats, 0) << seed;
  }
  EXPECT_GE(shown, 4);
}

TEST(ContrastJudge, NoiseAndSlopesRaiseNoMoreAlarmsThanStated) {
  EXPECT_LE(alarms(painted(slope, 3, 1)), 1);
}

TEST(ContrastJudge, BlotchesOnTheSurfaceRaiseNoMoreAlarmsThanStated) {
  for (const double contrast : {3.0, 15.0})
    EXPECT_LE(alarms(painted(blotches(3, contrast), 1, 1)), 1) << contrast;
}

TEST(ContrastJudge, AStepThatMovesWithTheViewIsNoEdge) {
  const auto step = [](double px) {
    return [px](const Vector2d& p, int v) {
      return 120 + (p.x() > px * kFootprint * (v - 4.5) ? 30 : 0);
    };
  };
  const CurvePoints line = line_on_plane(kOrigin, kUpright, 60);
  EXPECT_GT(judge_of(painted(step(0), 2, 1)).judge(line).nats, 10);
  EXPECT_LT(judge_of(painted(step(3), 2, 1)).judge(line).nats, 0);
}

TEST(ContrastJudge, WhatAKnownStrokeShowsIsNotShownTwice) {
  const EdgeWorld world =
      painted([](const Vector2d& p, int) { return 120 + (p.x() > 0 ? 30 : 0); }, 2, 1);
  const CurvePoints known = line_on_plane(kOrigin, kUpright, 100);
  const CurvePoints beside = line_on_plane({1.5 * kFootprint, 0}, kUpright, 60);
  EXPECT_GT(judge_of(world).judge(beside).nats, 0);
  ContrastJudge judge(world, known, no_edgels(world), {});
  EXPECT_LE(judge.judge(beside).nats, 0);
  ContrastJudge later = judge_of(world);
  later.take(known);
  EXPECT_LE(later.judge(beside).nats, 0);
}

CurvePoints circle_on_plane(const Vector2d& centre, double radius_px) {
  const double radius = radius_px * kFootprint;
  const int n = int(2 * M_PI * radius_px);
  CurvePoints out;
  out.position.resize(3, n), out.tangent.resize(3, n);
  for (int i = 0; i < n; ++i) {
    const double a = 2 * M_PI * (i + 0.5) / n;
    out.position.col(i) =
        Vector3d(centre.x() + radius * std::cos(a), centre.y() + radius * std::sin(a), 0);
    out.tangent.col(i) = Vector3d(-std::sin(a), std::cos(a), 0);
  }
  out.first = {0, n};
  return out;
}

// A hole of 6 px of radius whose centre is 14 px from the border of a plate: there is no room for
// copies beside its rim. What they would read is known from the border.
TEST(ContrastJudge, ASmallHoleNextToABorderShowsAndWhatIsBesideItDoesNot) {
  const double border = 14 * kFootprint, radius = 6 * kFootprint;
  const auto plate = [&](double step) {
    return [=](const Vector2d& p, int) {
      return (p.x() > border ? 60 : 120) + (p.norm() < radius ? step : 0);
    };
  };
  const CurvePoints known = line_on_plane({border, 0}, kUpright, 300);
  const CurvePoints rim = circle_on_plane(kOrigin, 6);
  const EdgeWorld with = painted(plate(25), 5, 1), without = painted(plate(0), 5, 1);
  const ContrastJudge judge(with, known, no_edgels(with), {});
  const double nats = judge.judge(rim).nats;
  EXPECT_GT(nats, 15);
  EXPECT_LT(judge.beside(rim), 0.2 * nats);
  EXPECT_LT(ContrastJudge(without, known, no_edgels(without), {}).judge(rim).nats, 0);
  // Half of the hole beside another one is no hole of its own.
  EXPECT_LT(judge.judge(circle_on_plane({-6 * kFootprint, 0}, 6)).nats, 0.2 * nats);
}

// In small pictures no view has strokes enough to tell its clutter by itself.
TEST(ContrastJudge, ViewsWithFewStrokesKnowTheirClutterFromAllTogether) {
  const double border = 14 * kFootprint, radius = 6 * kFootprint;
  const auto plate = [&](const Vector2d& p, int) {
    return (p.x() > border ? 60 : 120) + (p.norm() < radius ? 25 : 0);
  };
  const EdgeWorld world = painted(plate, 5, 1);
  const CurvePoints known = line_on_plane({border, 0}, kUpright, 80);
  EXPECT_GT(
      ContrastJudge(world, known, no_edgels(world), {}).judge(circle_on_plane(kOrigin, 6)).nats,
      15);
}

// Copies of its rim do not go beyond its middle, where the other side of it is.
TEST(ContrastJudge, TheOtherSideOfASmallHoleIsNoClutter) {
  const auto hole = [](const Vector2d& p, int) {
    return 120 + (p.norm() < 5 * kFootprint ? 20 : 0);
  };
  EXPECT_GT(judge_of(painted(hole, 5, 1)).judge(circle_on_plane(kOrigin, 5)).nats, 22);
}

TEST(AlarmThreshold, KeepsTheRateOfATailOfAnyWidthAndFallsBackOnMarkov) {
  EXPECT_NEAR(alarm_threshold({1, 2, 3}, 100, 0.05), std::log(2000), 1e-9);
  for (const double width : {1.0, 3.0}) {
    std::mt19937 rng(1);
    std::exponential_distribution<double> tail(1 / width);
    std::vector<double> nulls(1000);
    for (double& x : nulls) x = tail(rng);
    // exp(-x / width) * 1000 = 0.05
    EXPECT_NEAR(alarm_threshold(nulls, 1000, 0.05), width * std::log(20000), 0.25 * width * 10);
  }
}

// Few ratios above 0, however far below it the others lie.
TEST(AlarmThreshold, WhatNobodyWouldBelieveSaysNothingOfTheTail) {
  std::vector<double> near = {5, 4, 3, 2, 1}, far = near;
  for (int k = 0; k < 45; ++k) near.push_back(-0.1 - 0.01 * k), far.push_back(-20 - k);
  EXPECT_LT(alarm_threshold(near, 50, 0.05), alarm_threshold(far, 50, 0.05));
  EXPECT_NEAR(alarm_threshold(far, 50, 0.05), 3 * std::log(5 / 0.05), 1e-9);
}

}  // namespace
}  // namespace sketchsplat
