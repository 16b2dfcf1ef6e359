// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <algorithm>
#include <random>

#include "gmock/gmock.h"
#include "sketches/curve/curve.h"
#include "tests/topology/found_solid.h"
#include "tests/topology/solids.h"
#include "topology/faces/find_planes.h"
#include "topology/solid/cell_index.h"
#include "topology/solid/keep_faces.h"
#include "topology/solid/surface.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

int inferred_in(const Sketch& sketch) {
  const SolidSearch search = find_solid(sketch);
  const std::vector<bool> inferred = search.solid ? search.solid->inferred : std::vector<bool>();
  return int(std::count(inferred.begin(), inferred.end(), true));
}

Sketch box_edges() { return box_solid({0, 0, 0}, {3, 2, 1}).edges; }

TEST(FindSolid, TheEdgesOfABoxBoundTheBox) {
  const SolidSearch search = find_solid(box_edges());
  ASSERT_TRUE(search.solid) << search.why;
  EXPECT_EQ(search.solid->faces.size(), 6u);
  EXPECT_THAT(search.doubtful, IsEmpty());
  EXPECT_NEAR(volume_of(box_edges()), 6, 1e-9);
}

TEST(FindSolid, HolesAndPocketsAreTold) {
  const double disc = M_PI * 0.25 * 0.25;
  EXPECT_NEAR(volume_of(plate_with_hole(0.5).edges), 1 - 0.5 * disc, 1e-6);
  EXPECT_NEAR(volume_of(plate_with_hole(0.2).edges), 1 - 0.2 * disc, 1e-6);
}

// Two circles alone may be the rims of other things, too; masks tell in practice.
TEST(FindSolid, ConesAreToldIfTheLeastDescriptionIsEnough) {
  SolidOptions options;
  EXPECT_THAT(find_solid(cone_solid(0.5).edges, options).why, HasSubstr("another choice"));
  options.margin = 0.25;
  EXPECT_NEAR(check_of(find_solid(cone_solid(0.5).edges, options)).volume,
              M_PI / 3 * (1 + 0.5 + 0.25), 1e-6);
}

// A plate with a hole that narrows; `above` of twelve cameras look straight into it, the others
// from low around.
SolidSearch solid_of_tapered_hole(int above) {
  SolidMaker m;
  const Vector3d up = Vector3d::UnitZ();
  m.box({0, 0, 0}, {2, 1, 0.5});
  m.circle({0.6, 0.5, 0.5}, up, 0.25);
  m.circle({0.6, 0.5, 0}, up, 0.15);
  SolidEvidence evidence;
  for (int i = 0; i < 12; ++i) {
    const double angle = 2 * M_PI * i / 12;
    const Vector3d around(std::cos(angle), std::sin(angle), 0);
    const Vector3d from =
        Vector3d(0.6, 0.5, 0.5) + (i < above ? 1 : 20) * around + (i < above ? 20 : 1) * up;
    evidence.sights.push_back({from, {0, 0, 0.5}, false, 1});
  }
  SolidOptions options;
  options.margin = 0.25;
  return find_solid(m.solid.edges, options, evidence);
}

TEST(FindSolid, ATaperedHoleMustBeSeenIntoForItMayBeStepped) {
  EXPECT_TRUE(solid_of_tapered_hole(8).solid) << solid_of_tapered_hole(8).why;
  const SolidSearch few = solid_of_tapered_hole(7);
  EXPECT_FALSE(few.solid);
  EXPECT_THAT(few.why, HasSubstr("stepped"));
}

TEST(FindSolid, LinesThatNoImageCanShowAreInferred) {
  EXPECT_EQ(inferred_in(tongue_edges()), 2);
  EXPECT_NEAR(volume_of(tongue_edges()), 6 + M_PI / 2, 1e-6);
}

TEST(FindSolid, AnEdgeThatIsMissingIsInferred) {
  for (int s = 0; s < 12; ++s) {
    EXPECT_EQ(inferred_in(without(box_edges(), {s})), 1);
    EXPECT_NEAR(volume_of(without(box_edges(), {s})), 6, 1e-9);
  }
}

TEST(FindSolid, ALineOnAFaceIsDoubtfulAndRefused) {
  Sketch sketch = box_edges();
  const int a = sketch.add_node({1, 0.5, 1}), b = sketch.add_node({2, 1.5, 1});
  sketch.add_stroke(StrokeKind::kLine, a, b, {});
  const SolidSearch search = find_solid(sketch);
  EXPECT_FALSE(search.solid);
  EXPECT_THAT(search.doubtful, ElementsAre(12));
  EXPECT_THAT(search.why, HasSubstr("1 of 13 curves"));
}

TEST(KeepFaces, LeavesTheStrokesThatBoundThem) {
  const Solid shell =
      keep_faces(plate_with_hole(0.2), {true, true, true, true, true, true, false, false});
  EXPECT_EQ(shell.faces.size(), 6u);
  EXPECT_EQ(shell.edges.size(), 13) << "of the hole the upper rim is left";
  EXPECT_THAT(validate(shell.edges), IsEmpty());
  EXPECT_FALSE(write_solid_step(shell, "").valid) << "it is no solid";
}

// No margin is large enough.
TEST(FindSolid, FacesThatNoOtherChoiceDoesWithoutAreAShell) {
  SolidOptions surer;
  surer.margin = 1e9;
  const SolidSearch search = find_solid(plate_with_hole(0.2).edges, surer);
  EXPECT_FALSE(search.solid);
  EXPECT_EQ(search.faces, 8);
  ASSERT_TRUE(search.shell) << search.why;
  EXPECT_GE(search.shell->faces.size(), 4u);
  EXPECT_LT(search.shell->faces.size(), 8u);
  EXPECT_FALSE(find_solid(plate_with_hole(0.2).edges).shell) << "there is a solid";
}

TEST(FindSolid, WhatWouldTakeForeverIsRefusedAtOnce) {
  Sketch sketch = box_edges();
  SolidOptions impatient;
  impatient.nodes = 0;
  const SolidSearch undecided = find_solid(sketch, impatient);
  EXPECT_TRUE(undecided.solid || undecided.why == "no choice of faces is proven to be the best")
      << undecided.why;
  impatient = {};
  impatient.most_exclusive = -1;
  const SolidSearch many = find_solid(sketch, impatient);
  EXPECT_FALSE(many.solid || many.shell);
  EXPECT_EQ(many.why, "too many faces are possible");
  impatient = {};
  impatient.most_surfaces = 3;
  EXPECT_EQ(find_solid(sketch, impatient).why, "too many faces are possible");
}

TEST(FindSolid, WhereNearlyAllIsLeftOverNoMoreIsTried) {
  Sketch sketch = box_edges();
  for (int i = 0; i < 60; ++i) {  // far away, of no face
    const double x = 4 + 0.1 * i;
    const int a = sketch.add_node({x, 1e-3 * i * i, 3}), b = sketch.add_node({x + 0.05, 0, 4});
    sketch.add_stroke(StrokeKind::kLine, a, b, {});
  }
  const SolidSearch search = find_solid(sketch);
  EXPECT_FALSE(search.solid);
  EXPECT_EQ(search.doubtful.size(), 60u);
  EXPECT_EQ(search.margin, 0) << "how much worse the second choice is was not asked";
}

TEST(FindSolid, AnOpenFrameIsRefused) {
  // Of three edges of a side, and of none of its neighbours, nothing is known.
  EXPECT_FALSE(find_solid(without(box_edges(), {0, 1, 2, 3, 4})).solid);
  EXPECT_FALSE(find_solid(Sketch()).solid);
}

TEST(FindSolid, NoiseLeavesNoGaps) {
  Sketch sketch = plate_with_hole(0.5).edges;
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 2e-4);
  for (double& x : sketch.nodes.reshaped()) x += noise(random);
  for (double& x : sketch.handles.reshaped()) x += noise(random);
  const SolidSearch search = find_solid(sketch);
  ASSERT_TRUE(search.solid) << search.why;
  EXPECT_LT(search.solid->gap, 1e-6);
  for (int i = 0; i < sketch.nodes.cols(); ++i)
    EXPECT_LT(
        (search.solid->edges.nodes.colwise() - sketch.nodes.col(i)).colwise().norm().minCoeff(),
        2e-3);
  EXPECT_NEAR(volume_of(sketch), 1 - 0.5 * M_PI * 0.0625, 2e-3);
}

// Curves that a coarse tolerance lets stand off their surfaces are moved onto them; no surface may
// turn inside out on the way.
TEST(FindSolid, CoarseCurvesMoveOntoTheirSurfaces) {
  SolidOptions options;
  options.tolerance = 4e-3;
  options.margin = 0.25;
  for (int seed = 1; seed <= 20; ++seed) {
    Sketch sketch = plate_with_hole(0.5).edges;
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, 1.5e-3);
    for (double& x : sketch.nodes.reshaped()) x += noise(random);
    const SolidSearch search = find_solid(sketch, options);
    if (!search.solid) continue;  // noise may be too much for a plane
    EXPECT_NEAR(check_of(search).volume, 1 - 0.5 * M_PI * 0.0625, 0.02);
  }
}

TEST(FindSolid, OrderRotationAndScaleDoNotMatter) {
  const Sketch sketch = tongue_edges();
  Sketch other;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  other.nodes = (0.01 * turn * sketch.nodes).colwise() + Vector3d(5, -3, 1);
  for (int s = sketch.size() - 1; s >= 0; --s) {
    const Stroke& stroke = sketch.strokes[s];
    std::vector<Vector3d> handles;
    for (int h = 0; h < num_handles(stroke.kind); ++h)
      handles.push_back(0.01 * turn * sketch.handles.col(stroke.handle + h) + Vector3d(5, -3, 1));
    other.add_stroke(stroke.kind, stroke.begin, stroke.end, handles);
  }
  EXPECT_NEAR(volume_of(other), 1e-6 * (6 + M_PI / 2), 1e-10);
}

TEST(FindSolid, MasksThatContradictRefuse) {
  SolidEvidence evidence;
  for (int i = 0; i < 100; ++i)  // straight down through the box, and nothing is there
    evidence.rays.push_back({{0.02 * i + 0.3, 1, 9}, {0.02 * i + 0.3, 1, -9}, false});
  const SolidSearch search = find_solid(box_edges(), {}, evidence);
  EXPECT_FALSE(search.solid);
}

TEST(Evidence, AFaceThatPlacesAreSeenThroughHasAPrice) {
  const Sketch sketch = box_edges();
  const std::vector<Eigen::Matrix3Xd> polylines = polylines_of(sketch);
  const std::vector<SurfaceStrokes> surfaces = find_surfaces(sketch, polylines, 1e-3);
  std::vector<Cell> cells;
  for (size_t i = 0; i < surfaces.size(); ++i)
    for (const Cell& cell : cells_of(sketch, polylines, surfaces[i], int(i))) cells.push_back(cell);
  ASSERT_EQ(cells.size(), 6u);
  // From above, through the top alone, to a place in the middle.
  for (const bool seen : {true, false}) {
    SolidEvidence evidence;
    for (int i = 0; i < 20; ++i) evidence.sights.push_back({{1.5, 1, 9}, {1.5, 1, 0.5}, seen, 1});
    const EvidenceOfCells weighed = weigh_cells(evidence, surfaces, cells, 3, {});
    EXPECT_EQ(std::count_if(weighed.against.begin(), weighed.against.end(),
                            [](double nats) { return nats > 5; }),
              seen ? 1 : 0);
  }
}

// A sliver has a row of points, not millions of columns.
TEST(Cells, PointsWithinAreAboutAsManyAsAskedForHoweverThinTheCell) {
  const SurfaceStrokes plane{{SurfaceKind::kPlane, {0, 0, 0}, {0, 0, 1}}, {}, false};
  for (const double height : {1.0, 1e-3, 1e-13, 0.0}) {
    Cell cell;
    cell.polygons.resize(1);
    cell.polygons[0].resize(2, 4);
    cell.polygons[0] << 0, 1, 1, 0, 0, 0, height, height;
    const size_t count = points_within(cell, layout_of(plane), 20).size();
    EXPECT_GE(count, height > 0 ? 10u : 0u) << height;
    EXPECT_LE(count, 40u) << height;
  }
}

// By the parity of all pieces above a point and its copies a turn aside, none of them sorted.
bool holds(const Cell& cell, const Layout& layout, const Eigen::Vector2d& p) {
  const double period = layout.period();
  int above = 0;
  for (const Eigen::Matrix2Xd& polygon : cell.polygons)
    for (int i = 0; i < polygon.cols(); ++i) {
      Eigen::Vector2d a = polygon.col(i), b = polygon.col((i + 1) % polygon.cols());
      if (period > 0) b.x() += period * std::round((a.x() - b.x()) / period);
      for (int turn = period > 0 ? -3 : 0; turn <= (period > 0 ? 3 : 0); ++turn) {
        const double x = p.x() + turn * period;
        if ((a.x() > x) != (b.x() > x))
          above += p.y() < a.y() + (x - a.x()) / (b.x() - a.x()) * (b.y() - a.y());
      }
    }
  return above % 2 == 1;
}

TEST(CellIndex, SaysWhatTheSlowReferenceSays) {
  std::mt19937 random(4);
  for (const Solid& solid : {plate_with_hole(0.5), half_cylinder(), cone_solid(0.5)}) {
    const std::vector<Eigen::Matrix3Xd> polylines = polylines_of(solid.edges);
    const std::vector<SurfaceStrokes> surfaces = find_surfaces(solid.edges, polylines, 1e-3);
    int inside = 0;
    for (size_t i = 0; i < surfaces.size(); ++i)
      for (const Cell& cell : cells_of(solid.edges, polylines, surfaces[i], int(i))) {
        const Layout layout = layout_of(surfaces[i]);
        const CellIndex index(cell, layout);
        const FlatBox box = box_of(cell);
        std::uniform_real_distribution<double> place(-0.3, 1.3);
        for (int k = 0; k < 500; ++k) {
          const Eigen::Vector2d p = box.at(place(random), place(random));
          EXPECT_EQ(index.holds(p), holds(cell, layout, p));
          inside += index.holds(p);
        }
      }
    EXPECT_GT(inside, 300);
  }
}

std::vector<Surface> some_surfaces() {
  const Vector3d axis = Vector3d(1, 2, 2) / 3, place(0.1, 0, 0);
  return {{SurfaceKind::kPlane, place, axis},
          {SurfaceKind::kCylinder, place, axis, 0.8},
          {SurfaceKind::kCone, place, axis, 3, 0.4},
          {SurfaceKind::kSphere, place, axis, 0.8},
          {SurfaceKind::kTorus, place, axis, 0.8, 0, 0.4}};
}

TEST(Surface, CrossingsLieOnTheSurfaceAndNoneIsMissed) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-2, 2);
  for (const Surface& s : some_surfaces())
    for (int trial = 0; trial < 200; ++trial) {
      const Vector3d from(place(random), place(random), place(random)),
          to(place(random), place(random), place(random));
      const Crossings at = crossings(Layout(s), from, to);
      for (int k = 0; k < at.count; ++k)
        EXPECT_NEAR(surface_distance(s, from + at.t[k] * (to - from)), 0, 1e-9);
      const bool apart = surface_distance(s, from) * surface_distance(s, to) < 0;
      EXPECT_EQ(at.count % 2 == 1, apart);
    }
}

TEST(Surface, ALayoutFoldsBack) {
  for (const Surface& s : some_surfaces())
    for (const double u : {-1.0, 0.2, 1.5}) {
      const Layout layout(s, /*around_tube=*/u < 0);
      const Eigen::Vector2d flat(u, 0.3);
      EXPECT_NEAR((layout.flat(layout.point(flat)) - flat).norm(), 0, 1e-12);
      EXPECT_NEAR(surface_distance(s, layout.point(flat)), 0, 1e-12);
    }
}

}  // namespace
}  // namespace sketchsplat
