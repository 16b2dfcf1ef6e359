// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "edges/views/find_object.h"
#include "edges/views/focus.h"
#include "edges/views/lift.h"
#include "tests/support/wireframe.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPixel = 0.003;
const Vector3d kMiddle(0.5, 0.5, 0.4);

void add_segment(const Vector3d& a, const Vector3d& b, int views, std::vector<EdgePoint>* points) {
  const int n = int((b - a).norm() / (12 * kPixel));
  for (int i = 0; i <= n; ++i) {
    EdgePoint p;
    p.position = a + (b - a) * double(i) / n;
    p.tangent = (b - a).normalized();
    p.views = views;
    points->push_back(p);
  }
}

std::vector<Vector3d> cameras() {
  std::vector<Vector3d> out;
  for (const View& v : ring_of_views(20, kMiddle, 3)) {
    const Vector3d c = v.center_in_world();
    out.push_back({c.x(), c.y(), 0.5 + std::abs(c.z())});
  }
  return out;
}

// A cube of side 0.8 that stands on the plane z = 0 among boxes, on a striped table cloth.
std::vector<EdgePoint> cube_on_a_table() {
  std::vector<EdgePoint> points;
  for (const Polyline& e : cube_edges({0.1, 0.1, 0}, 0.8)) add_segment(e[0], e[1], 9, &points);
  for (const Polyline& e : cube_edges({1.3, 0.2, 0}, 0.3)) add_segment(e[0], e[1], 12, &points);
  for (const Polyline& e : cube_edges({-0.6, -0.5, 0}, 0.2)) add_segment(e[0], e[1], 12, &points);
  for (double x = -1; x < 2.2; x += 0.16)
    if (x < 0.1 || x > 0.9) add_segment({x, -1, 0}, {x, 2, 0}, 9, &points);
  return points;
}

// Points that single views agree on by chance.
void add_accidents(int count, std::vector<EdgePoint>* points) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> at(-1, 2), way(-1, 1);
  for (int i = 0; i < count; ++i) {
    EdgePoint p;
    p.position = {at(rng), at(rng), std::abs(at(rng))};
    p.tangent = Vector3d(way(rng), way(rng), way(rng)).normalized();
    p.views = 4;
    points->push_back(p);
  }
}

TEST(ObjectRegion, AnObjectOnATableIsToldFromWhatLiesAndStandsAroundIt) {
  for (int accidents : {0, 300}) {
    std::vector<EdgePoint> points = cube_on_a_table();
    add_accidents(accidents, &points);
    const ObjectRegion r = find_object(points, cameras(), kMiddle, 1.2, kPixel, {});
    ASSERT_TRUE(r.table);
    EXPECT_GT(r.table->normal().z(), 0.9999);
    EXPECT_LT(std::abs(r.table->offset()), kPixel);
    for (const Polyline& e : cube_edges({0.1, 0.1, 0}, 0.8))
      for (double t : {0.0, 0.3, 1.0}) EXPECT_TRUE(r.contains(e[0] + t * (e[1] - e[0])));
    EXPECT_FALSE(r.contains({1.3, 0.2, 0.3})) << "a box beside it";
    EXPECT_FALSE(r.contains({0.98, 0.5, 0})) << "a stripe of the cloth";
    EXPECT_FALSE(r.contains({0.5, 0.5, -0.1})) << "below the table";
    EXPECT_LT((r.box.sizes() - Vector3d::Constant(0.8)).norm(), 80 * kPixel);
  }
}

// The foot of a part with a chamfer is hardly higher than the print around it.
TEST(ObjectRegion, HowFlatPrintLiesTellsWhatStandsOnTheTable) {
  for (const double scatter_px : {0.2, 2.0}) {
    std::mt19937 rng(5);
    std::normal_distribution<double> scatter(0, scatter_px * kPixel);
    std::vector<EdgePoint> points = cube_on_a_table();
    for (EdgePoint& p : points)
      if (p.position.z() < kPixel) p.position.z() += scatter(rng);
    const ObjectRegion r = find_object(points, cameras(), kMiddle, 1.2, kPixel, {});
    ASSERT_TRUE(r.table);
    const Vector3d foot(0.9 + 8 * kPixel, 0.5, 3 * kPixel);  // beyond what is seen higher up
    EXPECT_EQ(r.contains(foot), scatter_px < 1) << scatter_px;
    EXPECT_FALSE(r.contains({foot.x(), 0.5, 0})) << scatter_px;
  }
}

TEST(ObjectRegion, TheRegionTurnsAndGrowsWithTheScene) {
  const std::vector<EdgePoint> points = cube_on_a_table();
  std::vector<EdgePoint> moved = points;
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(1.1, Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  const Vector3d shift(5, -3, 11);
  const double scale = 70;
  const auto move = [&](const Vector3d& x) { return Vector3d(scale * (R * x) + shift); };
  for (EdgePoint& p : moved) p.position = move(p.position), p.tangent = R * p.tangent;
  std::vector<Vector3d> seen_from = cameras();
  for (Vector3d& c : seen_from) c = move(c);
  const ObjectRegion a = find_object(points, cameras(), kMiddle, 1.2, kPixel, {}),
                     b = find_object(moved, seen_from, move(kMiddle), scale * 1.2, scale * kPixel,
                                     {});
  ASSERT_TRUE(b.table);
  for (const EdgePoint& p : points)
    EXPECT_EQ(a.contains(p.position), b.contains(move(p.position))) << p.position.transpose();
}

TEST(ObjectRegion, WithoutATableEverythingMayBelongToTheObject) {
  std::vector<EdgePoint> points;
  for (const Polyline& e : cube_edges({0.1, 0.1, 0}, 0.8)) add_segment(e[0], e[1], 9, &points);
  std::vector<Vector3d> around;
  for (const View& v : ring_of_views(20, kMiddle, 3)) around.push_back(v.center_in_world());
  add_accidents(50, &points);
  const ObjectRegion r = find_object(points, around, kMiddle, 1.2, kPixel, {});
  EXPECT_FALSE(r.table);
  for (const EdgePoint& p : points) EXPECT_TRUE(r.contains(p.position));
}

// Cloth, but for what lies beneath a disc about the middle.
std::vector<EdgePoint> cloth_around(double radius) {
  std::vector<EdgePoint> points;
  for (double x = -1; x < 2.2; x += 0.16)
    if (std::abs(x - 0.5) > radius + 0.02) add_segment({x, -1, 0}, {x, 2, 0}, 9, &points);
  return points;
}

// A point in twelve pixels, about the middle.
std::vector<Vector3d> add_ring(double radius, double height, std::vector<EdgePoint>* points) {
  const int n = int(2 * M_PI * radius / (12 * kPixel));
  std::vector<Vector3d> ring;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * M_PI * i / n;
    EdgePoint p;
    p.position = Vector3d(0.5 + radius * std::cos(a), 0.5 + radius * std::sin(a), height);
    p.tangent = Vector3d(-std::sin(a), std::cos(a), 0);
    p.views = 7;
    points->push_back(p);
    ring.push_back(p.position);
  }
  return ring;
}

TEST(ObjectRegion, RingsOnATableAreWhole) {
  for (const double radius_px : {50.0, 100.0}) {
    const double radius = radius_px * kPixel;
    std::vector<EdgePoint> points = cloth_around(radius);
    const std::vector<Vector3d> ring = add_ring(radius, 0.4, &points);
    const ObjectRegion r = find_object(points, cameras(), kMiddle, 1.2, kPixel, {});
    ASSERT_TRUE(r.table);
    for (const Vector3d& x : ring) EXPECT_TRUE(r.contains(x)) << radius_px;
    EXPECT_LT(r.box.sizes().head<2>().maxCoeff(), 2 * radius + 80 * kPixel);
  }
}

// The rim is farther from the hub than what stands beside the flange is from it.
TEST(ObjectRegion, TheRimOfAFlangeBelongsToItsHub) {
  const double hub = 50 * kPixel, rim = 190 * kPixel;
  std::vector<EdgePoint> points = cloth_around(rim);
  std::vector<Vector3d> own = add_ring(hub, 0.5, &points);
  for (const Vector3d& x : add_ring(rim, 0.1, &points)) own.push_back(x);
  const double beside = 0.5 + rim + 80 * kPixel;
  for (const Polyline& e : cube_edges({beside, 0.45, 0}, 0.1)) add_segment(e[0], e[1], 12, &points);
  const ObjectRegion r = find_object(points, cameras(), kMiddle, 1.2, kPixel, {});
  ASSERT_TRUE(r.table);
  for (const Vector3d& x : own) EXPECT_TRUE(r.contains(x)) << x.transpose();
  EXPECT_FALSE(r.contains({beside + 0.1, 0.5, 0.1})) << "a box beside it";
}

// One lone point is its own hull, and so are two.
TEST(ObjectRegion, WhatIsAroundNothingIsNotAroundTheObject) {
  std::vector<EdgePoint> points = cube_on_a_table();
  add_segment({1.6, 1.6, 0.3}, {1.6, 1.6, 0.36}, 12, &points);
  const ObjectRegion r = find_object(points, cameras(), kMiddle, 1.2, kPixel, {});
  ASSERT_TRUE(r.table);
  EXPECT_FALSE(r.contains({1.6, 1.6, 0.33}));
}

// Large things fall apart, seen from above, so that a neighbour may be taken for a part.
TEST(ObjectRegion, OnlyWhatHangsTogetherIsSurelyTheObjects) {
  std::vector<EdgePoint> points = cube_on_a_table();
  const double beside = 0.9 + 36 * kPixel;
  for (const Polyline& e : cube_edges({beside, 0.4, 0}, 0.1)) add_segment(e[0], e[1], 12, &points);
  const ObjectRegion r = find_object(points, cameras(), kMiddle, 1.2, kPixel, {});
  ASSERT_TRUE(r.table);
  EXPECT_TRUE(r.contains({beside + 0.05, 0.45, 0.1}));
  EXPECT_GT(r.edges.size(), 50u);
  for (const Vector3d& p : r.edges) EXPECT_LT(p.x(), beside) << p.transpose();
}

// Four posts about a hub, too far from it and each other to hang together.
TEST(ObjectRegion, WhatStandsAmongEdgesKnownBeforeBelongsToTheObject) {
  const double hub = 60 * kPixel, away = 0.4;
  std::vector<EdgePoint> points = cloth_around(0.6);
  add_ring(hub, 0.3, &points);
  RegionOptions look;
  std::vector<Vector3d> posts;
  for (int k = 0; k < 4; ++k) {
    const Vector3d foot(0.5 + (k & 1 ? away : -away), 0.5 + (k & 2 ? away : -away), 0.1);
    for (const Polyline& e : cube_edges(foot, 0.04)) add_segment(e[0], e[1], 12, &points);
    posts.push_back(foot + Vector3d::Constant(0.02));
    look.known.push_back(foot), look.known.push_back(foot + Vector3d(0.04, 0.04, 0));
  }
  const ObjectRegion first = find_object(points, cameras(), kMiddle, 1.2, kPixel, {});
  const ObjectRegion again = find_object(points, cameras(), kMiddle, 1.2, kPixel, look);
  ASSERT_TRUE(first.table && again.table);
  for (const Vector3d& x : posts) {
    EXPECT_FALSE(first.contains(x)) << "else this tests nothing";
    EXPECT_TRUE(again.contains(x)) << x.transpose();
  }
}

TEST(ObjectRegion, OfNothingNothingIsKnown) {
  EXPECT_TRUE(find_object({}, cameras(), kMiddle, 1, kPixel, {}).contains({9, 9, 9}));
  EXPECT_TRUE(find_object(cube_on_a_table(), {}, kMiddle, 1, kPixel, {}).box.isEmpty());
  EXPECT_TRUE(ObjectRegion().contains({9, 9, 9}));
}

// Two lines, drawn in this order, with as much meaning.
EdgelMap two_chains(const View& view) {
  EdgelMap map =
      ideal_edgels(view, {{{0.1, 0.1, 0.1}, {0.9, 0.1, 0.1}}, {{0.1, 3, 0.1}, {0.9, 3, 0.1}}});
  map.meaning = {2, 5};
  return map;
}

TEST(Focus, TheMostMeaningfulChainsAreTaken) {
  const View view = ring_of_views(3, {0.5, 1.5, 0.1}, 6)[0];
  const EdgelMap map = two_chains(view);
  ASSERT_EQ(map.num_chains(), 2);
  const int second = map.chain[2] - map.chain[1];
  const EdgelMap one = most_meaningful(map, second + 1);
  ASSERT_EQ(one.num_chains(), 1);
  EXPECT_EQ(int(one.edgels.size()), second);
  EXPECT_EQ(one.edgels.front().x, map.edgels[map.chain[1]].x);
  EXPECT_EQ(one.meaning, std::vector<float>{5});
  EXPECT_EQ(most_meaningful(map, 1e9).edgels.size(), map.edgels.size());
  EdgelMap unjudged = map;
  unjudged.meaning.clear();
  EXPECT_EQ(most_meaningful(unjudged, 1).edgels.size(), map.edgels.size());
}

// As surfels add theirs to those of the picture.
TEST(Focus, WhereSomeChainsWereJudgedAndOthersNotNoneIs) {
  const View view = ring_of_views(3, {0.5, 1.5, 0.1}, 6)[0];
  const EdgelMap judged = two_chains(view);
  EdgelMap unjudged = judged;
  unjudged.meaning.clear();
  const std::vector<char> all(judged.edgels.size(), 1);
  EdgelMap both;
  append_runs(judged, all, 1, &both);
  append_runs(judged, all, 1, &both);
  EXPECT_EQ(both.meaning, (std::vector<float>{2, 5, 2, 5}));
  append_runs(unjudged, all, 1, &both);
  append_runs(judged, all, 1, &both);
  EXPECT_EQ(both.num_chains(), 8);
  EXPECT_TRUE(both.meaning.empty());
}

TEST(Focus, EdgelsOutsideOfTheRegionGo) {
  std::vector<View> views;  // from above and below, where the lines are far apart in the images
  for (const View& v : ring_of_views(20, {0.5, 1.5, 0.1}, 6))
    if (std::abs(v.center_in_world().z()) > 5) views.push_back(v);
  ASSERT_GE(views.size(), 3u);
  std::vector<EdgelMap> maps;
  for (const View& v : views) maps.push_back(two_chains(v));
  const EdgeWorld world = make_edge_world(views, maps);
  ObjectRegion region;
  region.box = Eigen::AlignedBox3d(Vector3d(0, 0, 0), Vector3d(1, 0.2, 0.2));
  const EdgeWorld near = focused(world, region, 0);
  for (size_t v = 0; v < views.size(); ++v) {
    EXPECT_EQ(near.maps[v].num_chains(), 1);
    EXPECT_EQ(near.maps[v].edgels.size(), size_t(maps[v].chain[1]));
  }
  EXPECT_TRUE(near.bounds.isApprox(region.box));
  EXPECT_TRUE(near.object.contains({0.5, 0.1, 0.1}));
  EXPECT_EQ(focused(world, {}, 0).maps[0].num_chains(), 2);
}

}  // namespace
}  // namespace sketchsplat
