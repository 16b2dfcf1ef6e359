// SPDX-License-Identifier: MIT
#include "edges/surfels/fit/surfel_moves.h"

#include <gtest/gtest.h>

#include <cmath>

#include "edges/surfels/model/surfel_shading.h"
#include "tests/support/wireframe.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;
const Vector3d kMiddle(0.5, 0.5, 0);
constexpr int kSide = 20;  // surfels along the plate
constexpr double kSpacing = 0.6 / kSide;

// A plate of 0.6 x 0.6 in the plane z = 0, seen from above; its grey by place.
template <typename Grey>
std::vector<SurfelTarget> plate_targets(const Grey& grey) {
  std::vector<TrainingView> views;
  for (const View& view : ring_of_views(40, kMiddle, 2.5)) {
    const Vector3d eye = view.center_in_world();
    if (eye.z() < 1) continue;
    TrainingView t;
    t.view = view;
    t.view.camera = {200, 200, 200, 200, 99.5, 99.5};
    t.alpha = Image<float>(200, 200);
    for (Image<float>& c : t.color) c = t.alpha;
    for (int y = 0; y < 200; ++y)
      for (int x = 0; x < 200; ++x) {
        const Vector3d ray =
            view.cam_from_world.rotation.transpose() * t.view.camera.ray({double(x), double(y)});
        const Vector3d p = eye - eye.z() / ray.z() * ray;
        if (std::abs(p.x() - 0.5) > 0.3 || std::abs(p.y() - 0.5) > 0.3) continue;
        t.alpha.at(x, y) = 1;
        for (Image<float>& c : t.color) c.at(x, y) = float(grey(p.x(), p.y()));
      }
    views.push_back(t);
  }
  return make_targets(views, 200, kMiddle);
}

double print(double x, double y) {
  return 0.5 + 0.2 * std::sin(70 * x + 9 * y) + 0.2 * std::sin(55 * y - 12 * x);
}

// Surfels on the plate, but for a square of them that floats above it, askew.
bool floats(int i) { return std::abs(i % kSide - 9) < 3 && std::abs(i / kSide - 9) < 3; }
SurfelSet plate(double height, double tilt = 0.4) {
  SurfelSet set;
  set.values = Eigen::MatrixXd::Zero(SurfelSet::kRows, kSide * kSide);
  for (int i = 0; i < set.size(); ++i) {
    const double z = floats(i) ? height : 0;
    set.values.col(i).segment<3>(SurfelSet::kCenter) =
        Vector3d(0.2 + (i % kSide + 0.5) * kSpacing, 0.2 + (i / kSide + 0.5) * kSpacing, z);
    set.values.col(i).segment<4>(SurfelSet::kRotation) =
        rotation_to(Vector3d(0, z > 0 ? tilt : 0, 1).normalized());
  }
  set.values.middleRows<2>(SurfelSet::kLogScale).setConstant(std::log(0.6 * kSpacing));
  set.values.row(SurfelSet::kOpacity).setConstant(3);
  return set;
}

TEST(SurfelMoves, WhatFloatsAboveAPrintedPlaneComesDownToIt) {
  SurfelSet set = plate(0.08);
  const std::vector<int> moved =
      move_surfels(plate_targets(print), SurfelOptions(), kSpacing, {}, &set);
  int floating = 0;
  for (int i = 0; i < set.size(); ++i) floating += floats(i);
  int down = 0;
  for (const int i : moved) {
    EXPECT_TRUE(floats(i)) << "a surfel in its place moved: " << i;
    down += std::abs(set.values(SurfelSet::kCenter + 2, i)) < 1e-6;
  }
  EXPECT_GE(down, floating * 9 / 10);
}

TEST(SurfelMoves, WithoutContrastNothingMoves) {
  SurfelSet set = plate(0.08);
  const auto even = [](double, double) { return 0.5; };
  for (const int i : move_surfels(plate_targets(even), SurfelOptions(), kSpacing, {}, &set))
    EXPECT_FALSE(floats(i));
}

TEST(SurfelMoves, WithoutNeighboursOnAnotherPlaneNothingMoves) {
  SurfelSet set = plate(0.08, 0);
  std::vector<int> some;
  for (int i = 0; i < set.size(); ++i)
    if (floats(i)) some.push_back(i);
  set.values = Eigen::MatrixXd(set.values(Eigen::all, some));
  EXPECT_TRUE(move_surfels(plate_targets(print), SurfelOptions(), kSpacing, {}, &set).empty());
}

TEST(SurfelMoves, NoRoundsAndNoSurfelsAreNoError) {
  MoveOptions none;
  none.rounds = 0;
  SurfelSet set = plate(0.08), empty;
  empty.values.resize(SurfelSet::kRows, 0);
  const std::vector<SurfelTarget> targets = plate_targets(print);
  EXPECT_TRUE(move_surfels(targets, SurfelOptions(), kSpacing, none, &set).empty());
  EXPECT_TRUE(move_surfels(targets, SurfelOptions(), kSpacing, {}, &empty).empty());
}

}  // namespace
}  // namespace sketchsplat
