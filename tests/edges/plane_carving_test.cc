// SPDX-License-Identifier: MIT
#include "edges/surfels/start/plane_carving.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/edges/sure_edges_of.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;

// A solid cube from 0.1 to 0.9.
CellGrid solid() {
  CellGrid g;
  g.cell = 1.0 / 40;
  g.nx = g.ny = g.nz = 40;
  g.field.resize(g.size());
  for (int c = 0; c < g.size(); ++c)
    g.field[c] = float((0.4 - (g.center(c).array() - 0.5).abs().maxCoeff()) / g.cell);
  return g;
}

// Cameras above the cube.
std::vector<Vector3d> eyes_above() {
  std::vector<Vector3d> eyes;
  for (int k = 0; k < 12; ++k)
    eyes.push_back({0.5 + std::cos(0.5236 * k), 0.5 + std::sin(0.5236 * k), 3});
  return eyes;
}

const Vector3d kLow(0.26, 0.3, 0.42), kHigh(0.7, 0.74, 0.9);

// The edges of the cube, whose planes are outside, and those of a pocket, seen from above.
SureEdges pocket(const std::vector<Vector3d>& eyes) {
  SureEdges edges = sure_edges_of(box_edges(kLow, kHigh), 0.02, eyes);
  const auto hidden = [](const SightLine& line) {  // that do not come in by the mouth
    const double t = (kHigh.z() - line.point.z()) / (line.eye.z() - line.point.z());
    const Vector3d p = line.point + t * (line.eye - line.point);
    return !Eigen::AlignedBox3d(kLow, kHigh + Vector3d(0, 0, 1e-6)).contains(p);
  };
  edges.lines.erase(std::remove_if(edges.lines.begin(), edges.lines.end(), hidden),
                    edges.lines.end());
  const SureEdges outer = sure_edges_of(box_edges({0.1, 0.1, 0.1}, {0.9, 0.9, 0.9}), 0.02, {});
  Eigen::Matrix3Xd both(3, edges.position.cols() + outer.position.cols());
  both << edges.position, outer.position;
  edges.position = both;
  both << edges.tangent, outer.tangent;
  edges.tangent = both;
  return edges;
}

TEST(PlaneCarving, FloorAndWallsOfAPocketAreFlatThoughOnlyTheirEdgesAreSeen) {
  const CellGrid hull = solid();
  const SureEdges edges = pocket(eyes_above());
  const PlaneCarving carving(edges, edge_planes(edges), hull);
  CellGrid grid;
  EXPECT_GT(carving.carve(0.2, &grid), 0);
  const Eigen::AlignedBox3d inside(kLow, kHigh);
  for (int c = 0; c < grid.size(); ++c) {
    if (!(hull.field[c] > 0)) continue;
    EXPECT_EQ(grid.field[c] < 0, inside.contains(grid.center(c))) << grid.center(c).transpose();
  }
  // Above and below the floor the field is the distance to it, finer than the cells.
  const int k = int(kLow.z() / grid.cell);
  for (const int z : {k - 1, k, k + 1}) {
    const int c = grid.index(20, 20, z);
    EXPECT_NEAR(grid.field[c], (kLow.z() - grid.center(c).z()) / grid.cell, 0.05);
  }
}

TEST(PlaneCarving, NothingIsEmptyWithoutLines) {
  const CellGrid hull = solid();
  const SureEdges edges = pocket({});
  CellGrid grid;
  EXPECT_EQ(PlaneCarving(edges, edge_planes(edges), hull).carve(0.2, &grid), 0);
  EXPECT_EQ(grid.field, hull.field);
}

TEST(PlaneCarving, AFewWrongLinesEmptyNothing) {
  const CellGrid hull = solid();
  SureEdges edges = pocket({});
  for (int k = 0; k < 30; ++k)
    edges.lines.push_back({Vector3d(0.3 + 0.01 * k, 0.5, 3), Vector3d(0.3 + 0.01 * k, 0.5, 0.2)});
  CellGrid grid;
  EXPECT_EQ(PlaneCarving(edges, edge_planes(edges), hull).carve(0.2, &grid), 0);
}

TEST(PlaneCarving, TheMoreLinesMustCrossARegionTheFewerAreEmptied) {
  const CellGrid hull = solid();
  const SureEdges edges = pocket(eyes_above());
  const PlaneCarving carving(edges, edge_planes(edges), hull);
  CellGrid grid;
  int before = hull.size();
  for (const double share : {0.1, 0.3, 0.6, 0.95}) {
    const int carved = carving.carve(share, &grid);
    EXPECT_LE(carved, before);
    before = carved;
  }
  EXPECT_EQ(before, 0);
}

TEST(PlaneCarving, WithoutPlanesLeavesTheHull) {
  const CellGrid hull = solid();
  const SureEdges edges = pocket(eyes_above());
  CellGrid grid;
  EXPECT_EQ(PlaneCarving(edges, {}, hull).carve(0.2, &grid), 0);
  EXPECT_EQ(grid.field, hull.field);
}

// Lines from the bottom of a round hole, seen from above.
std::vector<SightLine> bore(int count) {
  std::vector<SightLine> lines;
  for (int k = 0; k < count; ++k) {
    const double r = 0.15 * std::sqrt(double(k) / count), a = 2.4 * k;
    const Vector3d floor(0.5 + r * std::cos(a), 0.5 + r * std::sin(a), 0.4);
    lines.push_back({floor + Vector3d(0, 0, 3), floor});
  }
  return lines;
}

TEST(CarveCrossed, OpensAHoleThatNoPlanesBound) {
  const CellGrid hull = solid();
  CellGrid grid = hull;
  const int carved = carve_crossed(bore(2000), 1, &grid);
  EXPECT_GT(carved, 0.7 * M_PI * 0.15 * 0.15 * 0.5 / std::pow(grid.cell, 3));
  for (int c = 0; c < grid.size(); ++c)
    if (hull.field[c] > 0 && grid.field[c] < 0) {
      EXPECT_LT((grid.center(c) - Vector3d(0.5, 0.5, 0)).head<2>().norm(), 0.15 + 2 * grid.cell);
      EXPECT_GT(grid.center(c).z(), 0.4);
    }
}

TEST(CarveCrossed, FewLinesDrillNoHole) {
  CellGrid grid = solid();
  EXPECT_EQ(carve_crossed(bore(20), 1, &grid), 0);
}

}  // namespace
}  // namespace sketchsplat
