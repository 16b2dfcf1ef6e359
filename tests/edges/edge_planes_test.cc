// SPDX-License-Identifier: MIT
#include "edges/surfels/start/edge_planes.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/edges/sure_edges_of.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;

bool parallel(const EdgePlane& plane, const Vector3d& normal, double offset) {
  return std::abs(std::abs(plane.normal().dot(normal)) - 1) < 1e-3 &&
         std::abs(std::abs(plane.offset()) - std::abs(offset)) < 1e-2;
}

TEST(EdgePlanes, ACubeHasSixThoughAnyTwoParallelEdgesShareOne) {
  const SureEdges edges = sure_edges_of(box_edges({0.2, 0.3, 0.1}, {0.8, 0.9, 0.7}), 0.02, {});
  const std::vector<EdgePlane> planes = edge_planes(edges);
  ASSERT_EQ(planes.size(), 6u);
  for (int axis = 0; axis < 3; ++axis)
    for (const Vector3d& corner : {Vector3d(0.2, 0.3, 0.1), Vector3d(0.8, 0.9, 0.7)})
      EXPECT_EQ(std::count_if(planes.begin(), planes.end(),
                              [&](const EdgePlane& p) {
                                return parallel(p, Vector3d::Unit(axis), corner[axis]);
                              }),
                1);
}

TEST(EdgePlanes, PrintOnTwoFacesMakesNoThirdPlane) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(0, 1);
  SureEdges edges;
  edges.footprint = 0.005;
  constexpr int kPoints = 1200;
  edges.position.resize(3, kPoints), edges.tangent.resize(3, kPoints);
  for (int i = 0; i < kPoints; ++i) {
    const double a = any(random), b = any(random), turn = M_PI * any(random);
    const bool floor = i % 2;
    edges.position.col(i) = floor ? Vector3d(a, b, 0) : Vector3d(a, 0, b);
    edges.tangent.col(i) = floor ? Vector3d(std::cos(turn), std::sin(turn), 0)
                                 : Vector3d(std::cos(turn), 0, std::sin(turn));
  }
  const std::vector<EdgePlane> planes = edge_planes(edges);
  ASSERT_EQ(planes.size(), 2u);
  EXPECT_NEAR(planes[0].normal().dot(planes[1].normal()), 0, 0.02);
}

TEST(EdgePlanes, OfFewPointsAreNone) {
  EXPECT_TRUE(edge_planes({}).empty());
  EXPECT_TRUE(edge_planes(sure_edges_of({segment({0, 0, 0}, {1, 0, 0})}, 0.01, {})).empty());
}

TEST(EdgePlanes, AreTheSameForAnyNumberOfThreads) {
  const SureEdges edges = sure_edges_of(box_edges({0.2, 0.3, 0.1}, {0.8, 0.9, 0.7}), 0.02, {});
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  const std::vector<EdgePlane> one = edge_planes(edges);
  omp_set_num_threads(3);
  const std::vector<EdgePlane> three = edge_planes(edges);
  omp_set_num_threads(before);
  ASSERT_EQ(one.size(), three.size());
  for (size_t k = 0; k < one.size(); ++k) EXPECT_EQ(one[k].coeffs(), three[k].coeffs());
}

}  // namespace
}  // namespace sketchsplat
