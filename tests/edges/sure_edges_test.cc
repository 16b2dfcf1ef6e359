// SPDX-License-Identifier: MIT
#include "edges/surfels/start/sure_edges.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/wireframe.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;

// Two parallel edges, and cameras in the plane of both, which see one edge, and elsewhere.
const Polyline kNear = segment({-0.4, 0, 0}, {0.4, 0, 0});
const Polyline kBeyond = segment({-0.4, 0.3, 0}, {0.4, 0.3, 0});
constexpr int kInPlane = 8, kElsewhere = 20;

View look(const Vector3d& from) {
  View v = ring_of_views(1, Vector3d::Zero(), 3)[0];
  const Vector3d forward = -from.normalized();
  const Vector3d right = forward.cross(Vector3d::UnitZ()).normalized();
  v.cam_from_world.rotation.row(0) = right;
  v.cam_from_world.rotation.row(1) = forward.cross(right);
  v.cam_from_world.rotation.row(2) = forward;
  v.cam_from_world.translation = -v.cam_from_world.rotation * from;
  return v;
}

EdgeWorld world_of(const std::vector<Polyline>& in_plane, const std::vector<Polyline>& elsewhere) {
  std::vector<View> near, other;
  for (int k = 0; k < kInPlane; ++k) {
    const double a = -M_PI / 2 + 0.1 * (k - 0.5 * (kInPlane - 1));
    near.push_back(look({3 * std::cos(a), 3 * std::sin(a), 0}));
  }
  for (int k = 0; k < kElsewhere; ++k) {
    const double a = 0.4 * k, up = k % 2 ? 0.7 : 1.1;
    other.push_back(
        look(3 * Vector3d(std::cos(a) * std::cos(up), std::sin(a) * std::cos(up), std::sin(up))));
  }
  EdgeWorld a = ideal_world(near, in_plane), b = ideal_world(other, elsewhere);
  a.views.insert(a.views.end(), b.views.begin(), b.views.end());
  a.maps.insert(a.maps.end(), b.maps.begin(), b.maps.end());
  return make_edge_world(a.views, a.maps);
}

CurvePoints tracks_of(const std::vector<Polyline>& lines) {
  CurvePoints out;
  constexpr int kPoints = 40;
  out.position.resize(3, kPoints * lines.size()), out.tangent.resize(3, kPoints * lines.size());
  out.first = {0};
  for (const Polyline& line : lines) {
    for (int k = 0; k < kPoints; ++k) {
      const int i = out.first.back() + k;
      out.position.col(i) = line[0] + (k + 0.5) / kPoints * (line[1] - line[0]);
      out.tangent.col(i) = (line[1] - line[0]).normalized();
    }
    out.first.push_back(out.first.back() + kPoints);
  }
  return out;
}

bool beyond(const Vector3d& p) { return p.y() > 0.15; }

TEST(SureEdges, PointsThatBorrowTheEdgelsOfABetterSeenEdgeAreNotSure) {
  const EdgeWorld world = world_of({kNear}, {kNear});
  SureEdgeOptions all;
  all.claim = 0;
  const CurvePoints tracks = tracks_of({kNear, kBeyond});
  const SureEdges sure = sure_edges(world, tracks), credulous = sure_edges(world, tracks, all);
  EXPECT_GT(credulous.position.cols(), 70) << "views in its plane see an edge in its place";
  EXPECT_GE(sure.position.cols(), 36);
  for (int i = 0; i < sure.position.cols(); ++i) EXPECT_FALSE(beyond(sure.position.col(i)));
  for (const SightLine& line : sure.lines) EXPECT_FALSE(beyond(line.point));
}

TEST(SureEdges, AnEdgelThatMayBeOfEitherOfTwoEdgesGivesNoLineOfSight) {
  const EdgeWorld world = world_of({kNear}, {kNear, kBeyond});
  const SureEdges sure = sure_edges(world, tracks_of({kNear, kBeyond}));
  EXPECT_GE(sure.position.cols(), 72);
  int in_plane = 0, to_beyond = 0;
  for (const SightLine& line : sure.lines) {
    // The ends of the nearer edge reach farther than those of the other.
    in_plane += std::abs(line.eye.z()) < 0.1 && std::abs(line.point.x()) < 0.3;
    to_beyond += beyond(line.point);
  }
  EXPECT_EQ(in_plane, 0);
  EXPECT_GT(to_beyond, 200);
}

TEST(SureEdges, LinesReachAllAlongAnEdge) {
  const EdgeWorld world = world_of({kNear}, {kNear});
  SureEdgeOptions single;
  single.fan = 1;
  const CurvePoints tracks = tracks_of({kNear});
  const size_t few = sure_edges(world, tracks, single).lines.size();
  const size_t many = sure_edges(world, tracks).lines.size();
  EXPECT_GT(few, 36u * (kInPlane + kElsewhere) * 9 / 10);
  EXPECT_GT(many, few * 5 / 2);
  EXPECT_LT(many, few * 3);
}

TEST(SureEdges, OfNothingAreNone) {
  const SureEdges sure = sure_edges(world_of({kNear}, {kNear}), tracks_of({}));
  EXPECT_EQ(sure.position.cols(), 0);
  EXPECT_TRUE(sure.lines.empty());
}

}  // namespace
}  // namespace sketchsplat
