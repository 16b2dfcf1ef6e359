// SPDX-License-Identifier: MIT
#include "edges/views/rim.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/wireframe.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;

const Vector3d kMiddle(0.5, 0.5, 0.5);

std::vector<View> views() { return ring_of_views(32, kMiddle, 3); }

// Where lines of sight touch a cylinder about the vertical axis through kMiddle: left and right.
std::vector<Polyline> contours(const View& view, double radius) {
  const Vector3d way = view.center_in_world() - kMiddle;
  const double direction = std::atan2(way.y(), way.x());
  const double aside = std::acos(radius / std::hypot(way.x(), way.y()));
  std::vector<Polyline> out;
  for (const double a : {direction + aside, direction - aside}) {
    const Vector3d foot = kMiddle + radius * Vector3d(std::cos(a), std::sin(a), 0);
    out.push_back(segment(foot - 0.4 * Vector3d::UnitZ(), foot + 0.4 * Vector3d::UnitZ()));
  }
  return out;
}

// Edgels of the curves with a bright object (towards kMiddle) or any normals.
EdgelMap edgels_of(const View& view, const std::vector<Polyline>& curves, bool bright,
                   std::mt19937* rng) {
  EdgelMap map = ideal_edgels(view, curves);
  double depth;
  const Eigen::Vector2d middle = view.project(kMiddle, &depth);
  std::normal_distribution<float> noise(0, 0.15f);
  for (Edgel& e : map.edgels) {
    const bool in = (middle.x() - e.x) * e.nx + (middle.y() - e.y) * e.ny > 0;
    if (bright ? !in : (*rng)() % 2) e.nx = -e.nx, e.ny = -e.ny;
    const float d = noise(*rng);
    e.x += d * e.nx, e.y += d * e.ny;
  }
  build_lookup(&map, 4);
  return map;
}

EdgeWorld world_of(double radius, const std::vector<Polyline>& edges, bool bright) {
  std::mt19937 rng(1);
  std::vector<EdgelMap> maps;
  for (const View& v : views()) {
    std::vector<Polyline> curves = edges;
    if (radius > 0)
      for (const Polyline& c : contours(v, radius)) curves.push_back(c);
    maps.push_back(edgels_of(v, curves, bright, &rng));
  }
  return make_edge_world(views(), maps);
}

// The same in other units of length: 1 is `unit` there.
EdgeWorld in_units(double unit, const EdgeWorld& world) {
  std::vector<View> views = world.views;
  for (View& v : views) v.cam_from_world.translation *= unit;
  return make_edge_world(views, world.maps);
}

CurvePoints vertical_line(double x, double y, double half) {
  CurvePoints c;
  const int n = 60;
  c.position.resize(3, n);
  c.tangent.resize(3, n);
  for (int i = 0; i < n; ++i) {
    c.position.col(i) = Vector3d(x, y, 0.5 - half + 2 * half * i / (n - 1));
    c.tangent.col(i) = Vector3d::UnitZ();
  }
  c.first = {0, n};
  return c;
}

TEST(Rim, TheContourOfACylinderTellsItsRadiusFromOneLineThatAFewViewsShareByChance) {
  const double radius = 0.1;
  for (const bool bright : {true, false}) {
    const EdgeWorld world = world_of(radius, {}, bright);
    const Rim rim = fit_rim(world, vertical_line(0.5 + 1.01 * radius, 0.5, 0.3), {});
    EXPECT_TRUE(rim.is_round(world.footprint)) << bright;
    EXPECT_NEAR(std::abs(rim.radius), radius, 0.1 * world.footprint);
    EXPECT_LT(rim.sigma, 0.2 * world.footprint);
    EXPECT_GT(rim.views, 2 * rim.fixed_views);
  }
}

TEST(Rim, AnEdgeIsNoRim) {
  const EdgeWorld world = world_of(0, cube_edges(Vector3d::Constant(0.1), 0.8), true);
  const Rim rim = fit_rim(world, vertical_line(0.1, 0.9, 0.3), {});
  EXPECT_FALSE(rim.is_round(world.footprint));
  EXPECT_EQ(rim.fixed_views, 32);
}

TEST(Rim, UnitsOfLengthDoNotMatter) {
  const EdgeWorld world = world_of(0, cube_edges(Vector3d::Constant(0.1), 0.8), true);
  for (const double unit : {1e-3, 1e3}) {
    CurvePoints line = vertical_line(0.1, 0.9, 0.3);
    line.position *= unit;
    EXPECT_EQ(fit_rim(in_units(unit, world), line, {}).fixed_views, 32) << unit;
  }
}

TEST(Rim, EdgesOfAThinSheetAreNoRimsThoughARoundBarWouldLookAlike) {
  // Four parallel edges, six pixels apart: the circle through them stays within two pixels of them.
  const double a = 3 * 3.0 / 500;
  std::vector<Polyline> edges;
  for (const double x : {-a, a})
    for (const double y : {-a, a})
      edges.push_back(segment(kMiddle + Vector3d(x, y, -0.4), kMiddle + Vector3d(x, y, 0.4)));
  const EdgeWorld world = world_of(0, edges, true);
  for (const double x : {-a, a})
    EXPECT_FALSE(
        fit_rim(world, vertical_line(0.5 + x, 0.5 + a, 0.3), {}).is_round(world.footprint));
}

TEST(Rim, ExplainsTheContoursInAllViewsAndNoEdgeBeside) {
  const double radius = 0.1;
  const std::vector<Polyline> edge = {segment({0.5, 0.85, 0.1}, {0.5, 0.85, 0.9})};
  const EdgeWorld world = world_of(radius, edge, true);
  const CurvePoints line = vertical_line(0.5 + 1.01 * radius, 0.5, 0.39);
  const Rim rim = fit_rim(world, line, {});
  ASSERT_TRUE(rim.is_round(world.footprint));
  EdgelFlags flags = no_edgels(world);
  explain_rim(world, line, rim, {}, &flags);
  int views = 0;
  for (size_t v = 0; v < flags.size(); ++v) {
    const EdgelMap& map = world.maps[v];
    views += std::count(flags[v].begin(), flags[v].end(), 1) > 0.6 * (map.chain[2] - map.chain[1]);
    double depth;
    for (size_t i = 0; i < flags[v].size(); ++i) {
      if (!flags[v][i]) continue;
      const Eigen::Vector2d at(map.edgels[i].x, map.edgels[i].y);
      double nearest = 1e9;
      for (const Polyline& c : contours(world.views[v], radius)) {
        const Eigen::Vector2d p = world.views[v].project(c[0], &depth);
        const Eigen::Vector2d t = (world.views[v].project(c[1], &depth) - p).normalized();
        nearest = std::min(nearest, std::abs(t.x() * (at - p).y() - t.y() * (at - p).x()));
      }
      EXPECT_LT(nearest, 3) << "view " << v;
    }
  }
  EXPECT_GE(views, 24);
}

}  // namespace
}  // namespace sketchsplat
