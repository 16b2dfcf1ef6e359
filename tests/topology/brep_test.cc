// SPDX-License-Identifier: MIT
#include <random>

#include "gmock/gmock.h"
#include "tests/topology/solids.h"
#include "topology/brep/solid_step.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

void expect_valid(const Solid& solid, double volume, double area) {
  const SolidCheck check = write_solid_step(solid, "");
  EXPECT_TRUE(check.valid) << check.why;
  EXPECT_NEAR(check.volume, volume, 1e-5 * volume);
  EXPECT_NEAR(check.area, area, 1e-5 * area);
  EXPECT_LT(check.tolerance, 1e-6);
}

TEST(Brep, FacesOfPlanesAndCylindersAreExact) {
  expect_valid(box_solid({0, 0, 0}, {1, 1, 1}), 1, 6);
  for (const double depth : {0.5, 0.2})  // through, and blind
    expect_valid(plate_with_hole(depth), 1 - M_PI / 16 * depth,
                 7 + M_PI / 2 * depth - (depth < 0.5 ? 0 : 2 * M_PI / 16));
  expect_valid(half_cylinder(), M_PI, M_PI + 2 * M_PI + 4);
  // The seam cuts a rim where it must. The mean height is 2; the cut is an ellipse with semi-axes
  // sqrt(1.25) and 1.
  expect_valid(cut_rod(), 2 * M_PI, 4 * M_PI + M_PI + M_PI * std::sqrt(1.25));
}

TEST(Brep, ConesEndInTheirApexOrBefore) {
  expect_valid(cone_solid(0.5), M_PI / 3 * 1.75, M_PI * 1.25 + M_PI * 1.5 * std::hypot(1, 0.5));
  expect_valid(cone_solid(0), M_PI / 3, M_PI + M_PI * std::sqrt(2.0));
  expect_valid(half_cone(), M_PI / 6, M_PI / 2 * std::sqrt(2.0) + M_PI / 2 + 1);
}

TEST(Brep, BallsAreWholeOrHavePolesOrCorners) {
  expect_valid(sphere_solid(), M_PI / 6, M_PI);
  expect_valid(ball_octant(), M_PI / 6, M_PI / 2 + 3 * M_PI / 4);
  for (const double height : {0.6, 0.0, -0.7})
    for (const Vector3d& up : {Vector3d(0, 0, 1), Vector3d(2.0 / 7, 3.0 / 7, 6.0 / 7)}) {
      const double h = 1 - height;
      expect_valid(ball_cap(height, up), M_PI * h * h * (1 - h / 3),
                   2 * M_PI * h + M_PI * (1 - height * height));
    }
}

TEST(Brep, ToriGoAroundTheirTubesAndTheirAxes) {
  expect_valid(elbow(), M_PI * M_PI / 4, M_PI * M_PI + M_PI / 2);
  SolidMaker whole;
  whole.face(torus_about_z(), false, {});
  expect_valid(whole.solid, M_PI * M_PI, 4 * M_PI * M_PI);
  // Pappus: a quarter disk has its centroid 4 r / (3 pi) off, a quarter circle 2 r / pi.
  const double disk = M_PI / 16, off = 2 / (3 * M_PI);
  const double bent = 2 * M_PI * (M_PI / 4) * (2 + 1 / M_PI);
  expect_valid(rounded_disk(), 2 * M_PI * (2 + off) * disk + M_PI * 2, bent + M_PI * (4 + 6.25));
}

TEST(Brep, AVoidIsNoSecondPiece) {
  SolidMaker m;
  m.box({0, 0, 0}, {4, 4, 4});
  const long outer = long(m.solid.faces.size());
  m.box({1, 1, 1}, {2, 2, 2});
  const Solid two = m.solid, turned = inside_out(m.solid);
  std::copy(turned.faces.begin() + outer, turned.faces.end(), m.solid.faces.begin() + outer);
  expect_valid(m.solid, 63, 96 + 6);
  EXPECT_THAT(write_solid_step(two, "").why, HasSubstr("more than one piece"));
}

TEST(Brep, SmallAndLargeWorldsAreTheSame) {
  for (const double size : {1e-4, 1e5}) {
    const SolidCheck check = write_solid_step(scaled(plate_with_hole(0.5), size), "");
    EXPECT_TRUE(check.valid) << check.why;
    EXPECT_NEAR(check.volume / std::pow(size, 3), 1 - M_PI / 16 * 0.5, 1e-6);
  }
}

TEST(Brep, WhatLooksInwardsIsTurned) {
  expect_valid(inside_out(plate_with_hole(0.2)), 1 - M_PI / 16 * 0.2, 7 + M_PI / 2 * 0.2);
  expect_valid(inside_out(cone_solid(0)), M_PI / 3, M_PI + M_PI * std::sqrt(2.0));
}

TEST(Brep, AnOpenBoxIsRefused) {
  Solid solid = box_solid({0, 0, 0}, {1, 1, 1});
  solid.faces.pop_back();
  const SolidCheck check = write_solid_step(solid, "");
  EXPECT_FALSE(check.valid);
  EXPECT_THAT(check.why, HasSubstr("it bounds 1 face, not two"));
}

TEST(Brep, ALoopTheWrongWayRoundIsRefused) {
  Solid solid = plate_with_hole(0.5);
  for (SolidFace& face : solid.faces)
    if (solid.surfaces[face.surface].kind == SurfaceKind::kCylinder) face.reversed = false;
  EXPECT_FALSE(write_solid_step(solid, "").valid);
  solid = box_solid({0, 0, 0}, {1, 1, 1});
  solid.faces[2].reversed = true;
  EXPECT_FALSE(write_solid_step(solid, "").valid);
}

TEST(Brep, AHoleOutsideOfItsFaceIsRefused) {
  Solid solid = plate_with_hole(0.5);
  for (const Stroke& s : solid.edges.strokes)
    if (s.kind == StrokeKind::kCircle) solid.edges.handles(0, s.handle) += 5;
  for (Surface& surface : solid.surfaces)
    if (surface.kind == SurfaceKind::kCylinder) surface.origin.x() += 5;
  EXPECT_FALSE(write_solid_step(solid, "").valid);
}

TEST(Brep, FacesThatRunThroughOneAnotherAreRefused) {
  // The wall of a blind hole that is deeper than its plate leaves through the bottom.
  Solid solid = plate_with_hole(0.49);
  for (Surface& surface : solid.surfaces)
    if (std::abs(surface.origin.z() - 0.01) < 1e-9) surface.origin.z() = -0.2;
  for (const Stroke& s : solid.edges.strokes)
    if (s.handle >= 0 && std::abs(solid.edges.handles(2, s.handle) - 0.01) < 1e-9)
      solid.edges.handles(2, s.handle) = -0.2;
  EXPECT_THAT(write_solid_step(solid, "").why, HasSubstr("it runs through itself: face "));
}

TEST(Brep, BadIndicesAreRefused) {
  const Solid box = box_solid({0, 0, 0}, {1, 1, 1});
  Solid solid = box;
  solid.faces[1].surface = 77;
  EXPECT_THAT(write_solid_step(solid, "").why, HasSubstr("it lies on no surface"));
  solid = box;
  solid.faces[1].loops[0][2].stroke = 77;
  EXPECT_THAT(write_solid_step(solid, "").why, HasSubstr("it names an edge that is not"));
  solid = box;
  std::swap(solid.faces[1].loops[0][2], solid.faces[1].loops[0][3]);
  EXPECT_THAT(write_solid_step(solid, "").why, HasSubstr("a loop of it is not closed"));
  EXPECT_FALSE(write_solid_step(Solid(), "").valid);
}

TEST(Brep, AGapBetweenCurvesAndSurfacesIsATolerance) {
  const std::vector<Solid> solids = some_solids();
  for (size_t i = 0; i < solids.size(); ++i) {
    const SolidCheck check = write_solid_step(perturbed(solids[i], 2e-6), "");
    EXPECT_TRUE(check.valid) << i << ": " << check.why;
    EXPECT_GT(check.tolerance, 1e-7) << i;
    EXPECT_LT(check.tolerance, 4e-5) << i;
    EXPECT_FALSE(write_solid_step(perturbed(solids[i], 2e-2), "").valid) << i;
  }
}

}  // namespace
}  // namespace sketchsplat
