// SPDX-License-Identifier: MIT
// Solids with spheres and tori, of which the free numbers are read from contours.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "gmock/gmock.h"
#include "tests/support/strokes.h"
#include "tests/topology/found_solid.h"
#include "tests/topology/solids.h"
#include "topology/faces/find_planes.h"
#include "topology/solid/cell_index.h"
#include "topology/solid/circle_rim.h"
#include "topology/solid/crossing_cells.h"
#include "topology/solid/round_families.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

// Lines that touch a surface of the unit kind at places for which `holds`, from all around.
std::vector<ContourLine> touching(const Surface& surface,
                                  const std::function<bool(const Vector3d&)>& holds, int count) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> angle(-M_PI, M_PI);
  const Layout layout(surface);
  std::vector<ContourLine> out;
  while (int(out.size()) < count) {
    const Eigen::Vector2d flat = layout.periods() / 2 / M_PI;
    const Vector3d p = layout.point({flat.x() * angle(random), surface.radius * angle(random) / 2});
    if (!holds(p)) continue;
    const Vector3d normal = surface_normal(surface, p),
                   along = normal.cross(Vector3d(angle(random), angle(random), angle(random)));
    out.push_back({p - 9 * along.normalized(), along.normalized()});
  }
  return out;
}

const auto everywhere = [](const Vector3d&) { return true; };
const auto above = [](const Vector3d& p) { return p.z() > 0; };

// The circles that bound the pipe of elbow() if it has straight ends of length 1 and is hollow; its
// bore begins at the same end, or at the other one.
Sketch pipe_edges(bool turned) {
  SolidMaker m;
  for (const double radius : {0.5, 0.3})
    for (const bool first : {true, false})
      if (first != (turned && radius < 0.5))
        m.circle({2, -1, 0}, Vector3d::UnitY(), radius);
      else
        m.circle({-1, 2, 0}, Vector3d::UnitX(), radius);
  return m.solid.edges;
}

// Rays through the middles of a grid about the origin, along z: through an object or beside it.
void add_rays(const std::function<bool(double, double)>& object, double reach,
              SolidEvidence* evidence) {
  constexpr int kSide = 40;
  for (int i = 0; i < kSide; ++i)
    for (int k = 0; k < kSide; ++k) {
      const double x = reach * (2 * i + 1 - kSide) / kSide, y = reach * (2 * k + 1 - kSide) / kSide;
      evidence->rays.push_back({{x, y, 9}, {x, y, -9}, object(x, y)});
    }
}

TEST(Contours, TellTheHeightOfACap) {
  const Surface sphere{SurfaceKind::kSphere, {0, 0, 0.75}, Vector3d::UnitZ(), 1.25};
  const RoundFamily family = caps({Vector3d::Zero(), Vector3d::UnitZ(), 1});
  const Contours contours(touching(sphere, above, 100), 1e-3);
  const std::optional<Contours::Fit> fit = contours.fit(family, -1.3, 1.3, 48, 20);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(std::tan(fit->parameter), 0.75, 1e-4);
  EXPECT_EQ(fit->lines.size(), 100u);
}

TEST(Contours, OfChanceTellNothing) {
  std::mt19937 random(3);
  std::normal_distribution<double> place(0, 1);
  std::vector<ContourLine> lines;
  for (int i = 0; i < 100; ++i)
    lines.push_back({{place(random), place(random), 9},
                     Vector3d(0.1 * place(random), 0.1 * place(random), -1).normalized()});
  const RoundFamily family = caps({Vector3d::Zero(), Vector3d::UnitZ(), 1});
  EXPECT_FALSE(Contours(lines, 1e-3).fit(family, -1.3, 1.3, 48, 20));
}

TEST(Contours, TellHowAGrooveBends) {
  const Surface torus{SurfaceKind::kTorus, Vector3d::Zero(), Vector3d::UnitZ(), 1, 0, 0.2};
  const auto inside = [](const Vector3d& p) { return p.head<2>().norm() < 1; };
  const RoundFamily family =
      rings({{0, 0, -0.2}, Vector3d::UnitZ(), 1}, {{0, 0, 0.2}, Vector3d::UnitZ(), 1});
  const Contours contours(touching(torus, inside, 100), 1e-3);
  const std::optional<Contours::Fit> fit = contours.fit(family, -0.1, -2.5, 48, 20);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->parameter, -M_PI / 2, 2e-2);
}

TEST(FindSolid, ContoursTellABallFromItsOneEdge) {
  SolidEvidence evidence;
  Solid cap = ball_cap(-0.5);
  cap.edges.evidence[0].confidence = 0.99999;
  evidence.contours = touching(
      cap.surfaces[0], [](const Vector3d& p) { return p.z() > -0.5; }, 90);
  const SolidSearch search = find_solid(cap.edges, {}, evidence);
  EXPECT_NEAR(check_of(search).volume, M_PI * 1.5 * 1.5 * (3 - 1.5) / 3, 1e-3);
}

TEST(FindSolid, ABentPipeHasTheRadiusOfItsContours) {
  SolidEvidence evidence;
  const Surface bend{SurfaceKind::kTorus, Vector3d::Zero(), Vector3d::UnitZ(), 2, 0, 0.5};
  evidence.contours = touching(
      bend, [](const Vector3d& p) { return p.x() > 0 && p.y() > 0; }, 200);
  add_rays(
      [](double x, double y) {
        if (x < 0 || y < 0) return std::min(x, y) > -1 && std::abs(std::max(x, y) - 2) < 0.5;
        return std::abs(std::hypot(x, y) - 2) < 0.5;
      },
      3, &evidence);
  for (const bool turned : {false, true}) {
    const SolidSearch search = find_solid(pipe_edges(turned), {}, evidence);
    EXPECT_EQ(search.faces, 8);
    EXPECT_NEAR(check_of(search).volume, M_PI * (0.25 - 0.09) * (M_PI + 2), 1e-3);
  }
}

TEST(CircleRim, IsOfCirclesAndOfEllipsesThatKeepToOne) {
  constexpr double kTolerance = 0.01;
  Sketch s;
  const auto ellipse = [&](double a, double b) {
    return s.add_stroke(StrokeKind::kEllipse, -1, -1, {{1, 2, 3}, {a, 0, 0}, {0, b, 0}});
  };
  const int near = ellipse(0.509, 0.491), far = ellipse(0.512, 0.488), small = ellipse(0.035, 0.03),
            circle = test::add_circle(&s, {1, 2, 3}, {0, 0, 0.5}),
            line = test::add_line(&s, {0, 0, 0}, {1, 0, 0}),
            straight = test::add_arc(&s, {0, 0, 0}, {0.5, 0, 0}, {1, 0, 0});
  for (const int stroke : {near, circle}) {
    const std::optional<CircleRim> rim = circle_rim(s, stroke, kTolerance);
    ASSERT_TRUE(rim);
    EXPECT_NEAR(rim->radius, 0.5, 1e-12);
    EXPECT_NEAR((rim->centre - Vector3d(1, 2, 3)).norm(), 0, 1e-12);
    EXPECT_NEAR(std::abs(rim->axis.z()), 1, 1e-12);
  }
  for (const int stroke : {far, small, line, straight})
    EXPECT_FALSE(circle_rim(s, stroke, kTolerance)) << stroke;
}

TEST(FindSolid, TwoCirclesOfABallAreEnoughEvenIfOneIsNearlyAnEllipse) {
  SolidEvidence evidence;
  add_rays([](double x, double y) { return std::hypot(x, y) < 1; }, 1.2, &evidence);
  const auto cap = [](double h) { return M_PI * h * h * (3 - h) / 3; };
  for (const double stretch : {0.0, 1e-3}) {
    SolidMaker m;
    m.circle({0, 0, 0.8}, Vector3d::UnitZ(), 0.6);
    if (stretch > 0)
      m.solid.edges.add_stroke(StrokeKind::kEllipse, -1, -1,
                               {{0, 0, -0.6}, {0.8 + stretch, 0, 0}, {0, 0.8 - stretch, 0}});
    else
      m.circle({0, 0, -0.6}, Vector3d::UnitZ(), 0.8);
    EXPECT_NEAR(check_of(find_solid(m.solid.edges, {}, evidence)).volume,
                4 * M_PI / 3 - cap(0.4) - cap(0.2), 1e-6 + 2 * stretch);
  }
}

TEST(Cells, ATorusBetweenTwoRimsHasTwo) {
  for (const bool around_tube : {false, true}) {
    const Surface torus{SurfaceKind::kTorus, Vector3d::Zero(), Vector3d::UnitZ(), 2, 0, 0.5};
    const Sketch sketch = around_tube ? elbow().edges : rounded_disk().edges;
    const std::vector<Cell> cells =
        cells_of(sketch, polylines_of(sketch), {torus, {0, 1}, around_tube}, 0);
    ASSERT_EQ(cells.size(), 2u);
    const Layout layout(torus, around_tube);
    const CellIndex index[2] = {{cells[0], layout}, {cells[1], layout}};
    // Three quarters of the ring or of the tube in the one, a quarter in the other.
    int in[2] = {0, 0};
    for (int i = 0; i < 400; ++i) {
      const Eigen::Vector2d flat =
          layout.periods().cwiseProduct(Eigen::Vector2d((i % 20 + 0.5) / 20, (i / 20 + 0.5) / 20));
      for (int k = 0; k < 2; ++k) in[k] += index[k].holds(flat);
    }
    EXPECT_EQ(std::max(in[0], in[1]), 300);
    EXPECT_EQ(std::min(in[0], in[1]), 100);
  }
}

// Of a zone of a sphere about the origin between two heights, closed by circles.
void add_zone(double radius, double low, double high, Sketch* sketch,
              std::vector<SurfaceStrokes>* surfaces) {
  SurfaceStrokes zone;
  zone.surface.kind = SurfaceKind::kSphere;
  zone.surface.origin = Eigen::Vector3d::Zero();
  zone.surface.axis = Eigen::Vector3d::UnitZ();
  zone.surface.radius = radius;
  for (const double z : {low, high}) {
    zone.strokes.push_back(sketch->size());
    sketch->add_stroke(
        StrokeKind::kCircle, -1, -1,
        {Eigen::Vector3d(0, 0, z), Eigen::Vector3d(0, 0, std::sqrt(radius * radius - z * z))});
  }
  surfaces->push_back(zone);
}

TEST(CrossingCells, ThinShellsDoNotRunThroughThemselves) {
  for (const double inner : {0.93, 0.98}) {
    Sketch sketch;
    std::vector<SurfaceStrokes> surfaces;
    add_zone(1, 0.1, 0.95, &sketch, &surfaces);
    add_zone(inner, 0.05, 0.92, &sketch, &surfaces);
    surfaces.push_back(surfaces.back());  // one that crosses the outer zone in a circle
    surfaces.back().surface.origin.z() = 0.3;
    surfaces.back().strokes.clear();
    for (const double z : {0.0, 1.2}) {
      surfaces.back().strokes.push_back(sketch.size());
      test::add_circle(&sketch, {0, 0, z},
                       {0, 0, std::sqrt(inner * inner - (z - 0.3) * (z - 0.3))});
    }
    const std::vector<Eigen::Matrix3Xd> polylines = polylines_of(sketch, 128);
    std::vector<Cell> cells;
    for (int i = 0; i < 3; ++i)
      for (Cell& cell : cells_of(sketch, polylines, surfaces[i], i))
        if (cell.loops.size() == 2) cells.push_back(std::move(cell));
    ASSERT_EQ(cells.size(), 3u);
    const std::vector<std::pair<int, int>> crossing = crossing_cells(surfaces, cells, 2e-3);
    EXPECT_EQ(std::count(crossing.begin(), crossing.end(), std::pair(0, 1)), 0) << inner;
    EXPECT_EQ(std::count(crossing.begin(), crossing.end(), std::pair(0, 2)), 1) << inner;
  }
}

}  // namespace
}  // namespace sketchsplat
