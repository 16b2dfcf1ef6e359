// SPDX-License-Identifier: MIT
#include "edges/views/lift.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>

#include "datasets/types/dense.h"
#include "edges/image/detect.h"
#include "edges/image/pull_of_blur.h"
#include "edges/views/link.h"
#include "edges/views/match.h"
#include "tests/support/strokes.h"
#include "tests/support/wireframe.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
const Eigen::Vector3d kMiddle(0.5, 0.5, 0.5);

TEST(EdgeWorld, BoundsHoldTheObjectTightly) {
  const std::vector<View> views = ring_of_views(20, kMiddle, 3);
  for (const bool masked : {false, true}) {
    std::vector<EdgelMap> maps;
    for (const View& v : views) {
      maps.push_back(ideal_edgels(v, cube_edges({0.1, 0.1, 0.1}, 0.8)));
      if (masked) maps.back().mask = convex_mask(v, cube_corners({0.1, 0.1, 0.1}, 0.8));
    }
    const EdgeWorld w = make_edge_world(views, maps);
    EXPECT_TRUE((w.bounds.min().array() <= 0.1).all());
    EXPECT_TRUE((w.bounds.max().array() >= 0.9).all());
    EXPECT_LT(w.bounds.sizes().maxCoeff(), masked ? 1.2 : 3.2) << "half of the views' field";
    EXPECT_NEAR(w.footprint, 3.0 / 500, 1e-4);
  }
}

TEST(EdgeWorld, ViewsWithoutEdgelsDoNotVote) {
  std::vector<View> views = ring_of_views(12, kMiddle, 3);
  std::vector<EdgelMap> maps;
  for (const View& v : views) maps.push_back(ideal_edgels(v, cube_edges({0.1, 0.1, 0.1}, 0.8)));
  maps[3] = EdgelMap();
  EXPECT_FALSE(make_edge_world(views, maps).bounds.isEmpty());
}

TEST(Lift, PointsOfACubeLieOnItsEdgesToATenthOfAPixel) {
  const std::vector<Polyline> curves = cube_edges({0.1, 0.1, 0.1}, 0.8);
  const EdgeWorld w = ideal_world(ring_of_views(20, kMiddle, 3), curves);
  const std::vector<EdgePoint> points = lift_edges(w, {});
  ASSERT_GE(points.size(), 200u);
  int good = 0;
  for (const EdgePoint& p : points) good += distance_to(curves, p.position) < 0.1 * w.footprint;
  EXPECT_GE(good, int(0.97 * points.size()));
  for (const Polyline& c : curves) {  // every edge is covered
    int on = 0;
    for (const EdgePoint& p : points) on += distance_to({c}, p.position) < w.footprint;
    EXPECT_GE(on, 15);
  }
}

TEST(Lift, TangentsFollowACircle) {
  const std::vector<Polyline> curves = {
      circle(kMiddle, Eigen::Vector3d(0.3, 0, 0), Eigen::Vector3d(0, 0.3, 0))};
  const EdgeWorld w = ideal_world(ring_of_views(20, kMiddle, 3), curves);
  const std::vector<EdgePoint> points = lift_edges(w, {});
  ASSERT_GE(points.size(), 50u);
  for (const EdgePoint& p : points) {
    const Eigen::Vector3d radius = (p.position - kMiddle).normalized();
    EXPECT_NEAR(p.tangent.norm(), 1, 1e-9);
    EXPECT_LT(std::abs(p.tangent.dot(radius)), 0.1);
  }
}

// Of two parallel edges three pixels apart, points go on along their own.
TEST(Lift, NeighboursOnAChainLieOnTheSameEdge) {
  std::vector<Polyline> curves;
  const double pixel = 3.0 / 500;
  for (const double x : {0.3, 0.3 + 3 * pixel, 0.3 + 6 * pixel})
    curves.push_back({{x, 0.2, 0.5}, {x, 0.8, 0.5}});
  const EdgeWorld w = ideal_world(ring_of_views(20, kMiddle, 3), curves);
  const std::vector<EdgePoint> points = lift_edges(w, {});
  for (const Polyline& c : curves) {
    std::vector<double> along;
    for (const EdgePoint& p : points)
      if (distance_to({c}, p.position) < 0.3 * w.footprint) along.push_back(p.position.y());
    std::sort(along.begin(), along.end());
    ASSERT_GE(along.size(), 20u);
    EXPECT_LT(along.front(), 0.2 + 8 * pixel);
    EXPECT_GT(along.back(), 0.8 - 8 * pixel);
    for (size_t i = 1; i < along.size(); ++i) EXPECT_LT(along[i] - along[i - 1], 8 * pixel);
  }
}

TEST(Lift, SameForOneAndTwoThreads) {
  const EdgeWorld w = ideal_world(ring_of_views(12, kMiddle, 3), cube_edges({0.1, 0.1, 0.1}, 0.8));
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  const std::vector<EdgePoint> one = lift_edges(w, {});
  omp_set_num_threads(2);
  const std::vector<EdgePoint> two = lift_edges(w, {});
  omp_set_num_threads(before);
  ASSERT_EQ(one.size(), two.size());
  for (size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].position, two[i].position);
    EXPECT_EQ(one[i].tangent, two[i].tangent);
  }
}

TEST(Lift, ResultScalesWithTheUnitOfTheScene) {
  for (double unit : {1e-3, 1e3}) {
    const EdgeWorld w = ideal_world(ring_of_views(12, unit * kMiddle, 3 * unit),
                                    cube_edges({0.1 * unit, 0.1 * unit, 0.1 * unit}, 0.8 * unit));
    const EdgeWorld w1 =
        ideal_world(ring_of_views(12, kMiddle, 3), cube_edges({0.1, 0.1, 0.1}, 0.8));
    const double ratio = double(lift_edges(w, {}).size()) / double(lift_edges(w1, {}).size());
    EXPECT_NEAR(ratio, 1, 0.02);
    EXPECT_NEAR(w.footprint / unit, w1.footprint, 1e-9);
  }
}

TEST(Lift, NothingToSeeGivesNoPoints) {
  EXPECT_TRUE(lift_edges(make_edge_world({}, {}), {}).empty());
  const std::vector<View> views = ring_of_views(5, kMiddle, 3);
  EXPECT_TRUE(lift_edges(make_edge_world(views, std::vector<EdgelMap>(5)), {}).empty());
}

TEST(Lift, AContourThatMovesWithTheViewIsNotLiftedByManyViews) {
  // The outline of a sphere: a circle that faces every camera, another one for each.
  std::vector<View> views = ring_of_views(30, kMiddle, 3);
  std::vector<EdgelMap> maps;
  for (const View& v : views) {
    const Eigen::Vector3d right = v.cam_from_world.rotation.row(0),
                          up = v.cam_from_world.rotation.row(1);
    maps.push_back(ideal_edgels(v, {circle(kMiddle, 0.3 * right, 0.3 * up)}));
  }
  const EdgeWorld w = make_edge_world(views, maps);
  for (const EdgePoint& p : lift_edges(w, {})) EXPECT_LE(p.views, 12);
}

TEST(Link, ACubeBecomesTwelveRunsOrFewer) {
  const EdgeWorld w = ideal_world(ring_of_views(20, kMiddle, 3), cube_edges({0.1, 0.1, 0.1}, 0.8));
  const std::vector<EdgePoint> thin = thin_points(lift_edges(w, {}), w.footprint);
  size_t linked = 0;
  int long_runs = 0;
  for (const PointChain& c : link_points(thin, w.footprint)) {
    linked += c.points.size();
    long_runs += c.points.size() >= 12;
  }
  EXPECT_GE(linked, size_t(0.95 * thin.size()));
  EXPECT_LE(long_runs, 14);
  EXPECT_GE(long_runs, 3);
}

TEST(Link, ACircleIsOneClosedRun) {
  const EdgeWorld w =
      ideal_world(ring_of_views(20, kMiddle, 3),
                  {circle(kMiddle, Eigen::Vector3d(0.3, 0, 0), Eigen::Vector3d(0, 0.3, 0))});
  const std::vector<PointChain> chains =
      link_points(thin_points(lift_edges(w, {}), w.footprint), w.footprint);
  ASSERT_FALSE(chains.empty());
  size_t longest = 0;
  for (size_t i = 1; i < chains.size(); ++i)
    if (chains[i].points.size() > chains[longest].points.size()) longest = i;
  EXPECT_TRUE(chains[longest].closed);
}

TEST(Link, PointsInOnePlaceAndLonePointsDoNoHarm) {
  EXPECT_TRUE(link_points({}, 1).empty());
  EXPECT_TRUE(thin_points({}, 1).empty());
  EdgePoint p;
  p.tangent = Eigen::Vector3d::UnitX();
  EXPECT_TRUE(link_points({p}, 1).empty());
  EXPECT_EQ(thin_points({p, p, p}, 1).size(), 1u);
  EXPECT_TRUE(link_points({p, p}, 1).empty());
}

TEST(Match, QuadraticTellsTheOffsetOfALineAcrossIt) {
  const Eigen::Vector3d a(0.1, 0.4, 0.5), b(0.9, 0.4, 0.5), offset(0, 0.002, -0.001);
  const EdgeWorld w = ideal_world(ring_of_views(20, kMiddle, 3), {segment(a, b)});
  const Matches m = match_samples(w, line_samples(a + offset, b + offset, 40), {});
  for (int i = 5; i < 35; ++i) {
    ASSERT_GE(m.views_of(i), 10);
    const Eigen::Matrix3d H = m.information[i] + 1e-3 * m.information[i].trace() *
                                                     Eigen::Vector3d::UnitX() *
                                                     Eigen::RowVector3d::UnitX();
    const Eigen::Vector3d move = -solve_symmetric(H, m.slope.col(i));
    EXPECT_LT((move + offset).norm(), 2e-4);
  }
}

TEST(Match, SamplesAreHeldWeaklyAlongTheirCurve) {
  const Eigen::Vector3d a(0.1, 0.5, 0.5), b(0.9, 0.5, 0.5);
  const EdgeWorld w = ideal_world(ring_of_views(20, kMiddle, 3), {segment(a, b)});
  const Matches m = match_samples(w, line_samples(a, b, 20), {});
  for (int i = 2; i < 18; ++i) {
    const Eigen::Vector3d t = Eigen::Vector3d::UnitX();
    const double along = t.dot(m.information[i] * t), all = m.information[i].trace();
    ASSERT_GT(all, 0);
    EXPECT_GT(along, 1e-4 * all) << "or a few foreign edgels make the whole line slide";
    EXPECT_LT(along, 0.05 * all) << "or lines cannot grow";
  }
}

TEST(Match, AnEdgelBelongsToTheNearerOfTwoLinesFourPixelsApart) {
  const double gap = 4 * 3.0 / 500;
  const Eigen::Vector3d a(0.1, 0.5, 0.5), b(0.9, 0.5, 0.5), up(0, gap, 0);
  const EdgeWorld w =
      ideal_world(ring_of_views(20, kMiddle, 3), {segment(a, b), segment(a + up, b + up)});
  CurvePoints both = line_samples(a, b, 30);
  const CurvePoints second = line_samples(a + up, b + up, 30);
  both.position.conservativeResize(3, 60), both.tangent.conservativeResize(3, 60);
  both.position.rightCols(30) = second.position, both.tangent.rightCols(30) = second.tangent;
  both.first = {0, 30, 60};
  const Matches m = match_samples(w, both, {});
  // In a view or two the lines project into the same pixels; everywhere else nothing is mixed up.
  size_t own = 0;
  for (const SampleMatch& s : m.matches) own += std::abs(s.distance_px) < 0.05;
  EXPECT_GT(m.matches.size(), 600u);
  EXPECT_GT(own, size_t(0.95 * m.matches.size()));
}

// A bright disc of 5 px radius about (31.7, 32.2), each pixel by how much of it the disc covers.
Picture disc_picture() {
  Picture p;
  p.red = Image<float>(64, 64, 0.3f);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      for (int k = 0; k < 256; ++k) {
        const double dx = x - 31.7 + (k % 16 - 7.5) / 16, dy = y - 32.2 + (k / 16 - 7.5) / 16;
        if (std::hypot(dx, dy) < 5) p.red.at(x, y) += 0.4f / 256;
      }
  p.green = p.blue = p.red;
  return p;
}

TEST(Match, ASmallDiscIsAsLargeAsItIsThoughBlurPullsItsEdgeInwards) {
  View view;
  view.camera = {64, 64, 100, 100, 31.7, 32.2};
  const EdgeWorld w = make_edge_world({view}, {detect_edges(disc_picture(), {})});
  CurvePoints disc;
  disc.position.resize(3, 60), disc.tangent.resize(3, 60);
  for (int i = 0; i < 60; ++i) {
    const double a = 2 * M_PI * i / 60;
    disc.position.col(i) << 0.05 * std::cos(a), 0.05 * std::sin(a), 1;
    disc.tangent.col(i) << -std::sin(a), std::cos(a), 0;
  }
  disc.first = {0, 60};
  const auto outwards = [&] {  // edgels' normals point to the bright disc
    const Matches m = match_samples(w, disc, {});
    EXPECT_GT(m.matches.size(), 50u);
    double sum = 0;
    for (const SampleMatch& s : m.matches) sum -= s.distance_px;
    return sum / double(m.matches.size());
  };
  EXPECT_GT(outwards(), 0.08) << "or the test shows nothing";
  disc.curvature = -disc.position / (0.05 * 0.05);
  disc.curvature.row(2).setZero();
  EXPECT_NEAR(outwards(), 0, 0.02);
}

TEST(Match, ThePullOfBlurIsThatOfABlurredDisc) {
  // Where r I_1(r R / b^2) exp(-(r^2 + R^2) / 2 b^2) / r, the gradient, is steepest, for b = 1.
  const std::vector<std::pair<double, double>> bends = {
      {0.05, 0.0251}, {0.1, 0.05}, {0.3, 0.1447}, {0.5, 0.1919}, {0.6, 0.1557}, {0.7, 0.0849}};
  for (const auto& [curvature, pull] : bends) {
    EXPECT_NEAR(pull_of_blur(curvature, 1), pull, 0.025) << curvature;
    EXPECT_NEAR(pull_of_blur(curvature / 3, 3), 3 * pull, 0.075) << "as long as the blur";
  }
  EXPECT_EQ(pull_of_blur(0, 1), 0);
  EXPECT_EQ(pull_of_blur(5, 1), 0) << "a speck";
}

TEST(Match, SamplesBehindTheCameraOutsideOrNowhereMatchNothing) {
  const EdgeWorld w =
      ideal_world(ring_of_views(4, kMiddle, 3), {segment({0.1, 0.5, 0.5}, {0.9, 0.5, 0.5})});
  EXPECT_TRUE(match_samples(w, line_samples({50, 50, 50}, {51, 50, 50}, 5), {}).matches.empty());
  CurvePoints none;
  none.first = {0};
  none.position.resize(3, 0), none.tangent.resize(3, 0);
  EXPECT_TRUE(match_samples(w, none, {}).matches.empty());
  CurvePoints nan = line_samples({0.1, 0.5, 0.5}, {0.9, 0.5, 0.5}, 5);
  nan.position.setConstant(std::nan(""));
  EXPECT_TRUE(match_samples(w, nan, {}).matches.empty());
}

TEST(Match, CurveWithoutSamplesMatchesNothing) {
  EdgeWorld world;
  world.views.resize(1), world.maps.resize(1), world.plane_normal.resize(1);
  MatchOptions options;
  options.max_bias = 0.5;
  const Matches m =
      match_samples(world, {Eigen::Matrix3Xd(3, 0), Eigen::Matrix3Xd(3, 0), {0, 0}}, options);
  EXPECT_TRUE(m.matches.empty());
  EXPECT_EQ(m.sigma_px, 0);
}

TEST(Match, EdgelsBetweenTheSamplesOfTheNearerCurveAreItsToo) {
  const Eigen::Vector3d from(0.2, 0.5, 0.5), way(0.6, 0, 0);
  const EdgeWorld w = ideal_world(ring_of_views(12, kMiddle, 3), {segment(from, from + way)});
  // A curve on the edge, and one half a pixel beside it whose samples lie between the other's.
  CurvePoints samples;
  constexpr int kCount = 33;  // three pixels apart
  samples.position.resize(3, 2 * kCount);
  samples.tangent = way.normalized().replicate(1, 2 * kCount);
  for (int i = 0; i < kCount; ++i) {
    samples.position.col(i) = from + way * (i + 0.25) / kCount;
    samples.position.col(kCount + i) =
        from + way * (i + 0.75) / kCount + 0.5 * w.footprint * Eigen::Vector3d(0, 0.7, 0.7);
  }
  samples.first = {0, kCount, 2 * kCount};
  for (bool between : {false, true}) {
    MatchOptions options;
    options.exclusive_between = between;
    const Matches m = match_samples(w, samples, options);
    const int nearer = m.first[kCount], other = m.first[2 * kCount] - nearer;
    EXPECT_GT(nearer, 12 * kCount * 3 / 4);
    EXPECT_EQ(other > nearer / 4, !between) << other;
  }
}

}  // namespace
}  // namespace sketchsplat
