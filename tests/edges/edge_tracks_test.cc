// SPDX-License-Identifier: MIT
#include "edges/surfels/start/edge_tracks.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <random>

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

constexpr int kSize = 120;

// What a ray from `eye` (z > 0) along `way` meets: where, and the normal there; false: nothing.
using Shape = std::function<bool(const Vector3d& eye, const Vector3d& way, double* s, Vector3d* n)>;

// A roof over the y axis whose sides turn by `degrees`; 0: the plane z = 0.
Shape roof(double degrees) {
  const double half = 0.5 * degrees * M_PI / 180;
  return [half](const Vector3d& eye, const Vector3d& way, double* s, Vector3d* n) {
    for (const double side : {-1.0, 1.0}) {
      *n = {side * std::sin(half), 0, std::cos(half)};
      *s = -n->dot(eye) / n->dot(way);
      if (side * (eye + *s * way).x() >= 0) return true;
    }
    return false;
  };
}

// The plane z = 0 with a hole of radius 0.15 and depth 0.4.
bool hole(const Vector3d& eye, const Vector3d& way, double* s, Vector3d* n) {
  constexpr double kRadius = 0.15, kDepth = 0.4;
  *n = {0, 0, 1};
  *s = -eye.z() / way.z();
  if ((eye + *s * way).head<2>().norm() > kRadius) return true;
  *s = -(eye.z() + kDepth) / way.z();
  if ((eye + *s * way).head<2>().norm() < kRadius) return true;
  const double a = way.head<2>().squaredNorm(), b = eye.head<2>().dot(way.head<2>());
  const double c = eye.head<2>().squaredNorm() - kRadius * kRadius;
  *s = (-b + std::sqrt(b * b - a * c)) / a;
  const Vector3d p = eye + *s * way;
  *n = Vector3d(-p.x(), -p.y(), 0).normalized();
  return true;
}

View view_from(const Vector3d& eye) {
  View view;
  view.camera = {kSize, kSize, 200, 200, 59.5, 59.5};
  const Vector3d forward = -eye.normalized();
  const Vector3d right = forward.cross(Vector3d(0, 1, 0.1)).normalized();
  view.cam_from_world.rotation.row(0) = right.transpose();
  view.cam_from_world.rotation.row(1) = forward.cross(right).transpose();
  view.cam_from_world.rotation.row(2) = forward.transpose();
  view.cam_from_world.translation = -(view.cam_from_world.rotation * eye);
  return view;
}

// The geometry of a view; normals err by `noise_deg` over patches of six pixels, each view by
// itself.
GeometryMaps maps_of(const View& view, const Shape& shape, double noise_deg, int seed) {
  constexpr int kPatch = 6;
  std::mt19937 rng(seed);
  std::normal_distribution<double> noise(0, noise_deg * M_PI / 180);
  std::vector<Vector3d> errors(kSize * kSize);
  for (Vector3d& e : errors) e = {noise(rng), noise(rng), noise(rng)};
  GeometryMaps maps;
  maps.depth = maps.alpha = Image<float>(kSize, kSize);
  maps.normal.fill(Image<float>(kSize, kSize));
  const Eigen::Matrix3d R = view.cam_from_world.rotation;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      double s;
      Vector3d n;
      const Vector3d way = R.transpose() * view.camera.ray({double(x), double(y)});
      if (!shape(view.center_in_world(), way, &s, &n)) continue;
      const Vector3d seen = (R * n + errors[y / kPatch * kSize + x / kPatch]).normalized();
      maps.depth.at(x, y) = float(s);
      maps.alpha.at(x, y) = 1;
      for (int c = 0; c < 3; ++c) maps.normal[c].at(x, y) = float(seen[c]);
    }
  return maps;
}

// A curve in space, seen by five views of a shape as edgels of their pictures.
struct Seen {
  EdgeWorld world;
  CurvePoints track;
  std::vector<TrackSightings> sightings;
  std::vector<std::vector<EdgelSupport>> support;

  Seen(const std::function<Vector3d(double)>& curve, const Shape& shape, double noise_deg,
       bool outline = false) {
    constexpr int kPoints = 40;
    track = {Eigen::Matrix3Xd(3, kPoints), Eigen::Matrix3Xd(3, kPoints), {0, kPoints}};
    for (int i = 0; i < kPoints; ++i) {
      const double t = (i + 0.5) / kPoints;
      track.position.col(i) = curve(t);
      track.tangent.col(i) = (curve(t + 1e-4) - curve(t - 1e-4)).normalized();
    }
    std::vector<View> views;
    std::vector<EdgelMap> maps;
    for (const double x : {-0.8, -0.4, 0.1, 0.5, 0.9}) {
      views.push_back(view_from({x, 0.6, 2}));
      maps.push_back(picture(views.back(), curve, outline));
    }
    world = make_edge_world(views, maps);
    sightings = track_sightings(world, track, 2);
    for (size_t v = 0; v < views.size(); ++v)
      support.push_back(
          edgel_support(object_maps(maps_of(views[v], shape, noise_deg, int(v)), views[v].camera),
                        maps[v], sightings[v].place, {}));
  }

  static EdgelMap picture(const View& view, const std::function<Vector3d(double)>& curve,
                          bool outline) {
    EdgelMap map;
    map.width = map.height = kSize;
    double depth;
    for (double t = 0; t < 1; t += 0.012) {
      const Eigen::Vector2d p = view.project(curve(t), &depth);
      const Eigen::Vector2d d = view.project(curve(t + 1e-4), &depth) - p;
      Edgel e;
      e.x = float(p.x()), e.y = float(p.y());
      e.nx = float(-d.y() / d.norm()), e.ny = float(d.x() / d.norm());
      e.outline = outline;
      map.edgels.push_back(e);
    }
    map.chain = {0, int(map.edgels.size())};
    build_lookup(&map, 4);
    return map;
  }

  // Share of the points of a kind.
  double share(EdgeKind kind) const {
    const std::vector<EdgeKind> kinds = judge_tracks(track, sightings, support, 3);
    return double(std::count(kinds.begin(), kinds.end(), kind)) / double(kinds.size());
  }
};

Vector3d along_y(double t) { return {0, 0.5 * t - 0.25, 0}; }

TEST(JudgeTracks, ALineOnAFlatFaceIsPrintThoughNormalsAreNoisy) {
  for (const double noise : {0.0, 2.5})
    EXPECT_GT(Seen(along_y, roof(0), noise).share(EdgeKind::kPrint), 0.99) << noise;
}

TEST(JudgeTracks, ACreaseOf15DegreesIsAnEdgeThoughNormalsAreNoisy) {
  for (const double noise : {0.0, 2.0})
    EXPECT_GT(Seen(along_y, roof(15), noise).share(EdgeKind::kShape), 0.99) << noise;
  EXPECT_GT(Seen(along_y, roof(60), 4).share(EdgeKind::kShape), 0.99);
}

TEST(JudgeTracks, AnOutlineIsAnEdge) {
  EXPECT_GT(Seen(along_y, roof(0), 0, true).share(EdgeKind::kShape), 0.99);
}

TEST(JudgeTracks, ARimOfAHoleIsAnEdgeAndARingAroundItIsPrint) {
  const auto ring = [](double radius) {
    return [radius](double t) {
      return Vector3d(radius * std::cos(2 * M_PI * t), radius * std::sin(2 * M_PI * t), 0);
    };
  };
  EXPECT_GT(Seen(ring(0.15), hole, 2).share(EdgeKind::kShape), 0.9);
  EXPECT_GT(Seen(ring(0.3), hole, 2).share(EdgeKind::kPrint), 0.9);
}

TEST(JudgeTracks, WhatLiesOffTheGeometryIsUnknown) {
  const auto below = [](double t) { return Vector3d(0, 0.5 * t - 0.25, -0.2); };
  EXPECT_EQ(Seen(below, roof(0), 0).share(EdgeKind::kUnknown), 1);
}

TEST(EdgelKinds, GoToTheEdgelsAroundSightingsButNotRoundACornerOrWhereItIsFlat) {
  Seen seen(along_y, roof(60), 0);
  std::vector<EdgeKind> kinds = judge_tracks(seen.track, seen.sightings, seen.support, 3);
  const auto share = [&](size_t view) {
    const std::vector<EdgeKind> of =
        edgel_kinds(seen.world, seen.sightings, seen.support, kinds, 3, 6)[view];
    return double(std::count(of.begin(), of.end(), EdgeKind::kShape)) / double(of.size());
  };
  EXPECT_GT(share(2), 0.95);
  for (EdgelSupport& s : seen.support[2]) s.edge = 0.1f;  // this view shows a flat face there
  EXPECT_EQ(share(2), 0);
  std::vector<Edgel>& edgels = seen.world.maps[1].edgels;
  const int corner = seen.sightings[1].place.back().edgel + 1;
  ASSERT_LT(corner, int(edgels.size()));
  for (size_t k = corner; k < edgels.size(); ++k) std::swap(edgels[k].nx, edgels[k].ny);
  const std::vector<EdgeKind> of =
      edgel_kinds(seen.world, seen.sightings, seen.support, kinds, 3, 6)[1];
  EXPECT_EQ(of[corner - 1], EdgeKind::kShape);
  EXPECT_EQ(of[corner], EdgeKind::kUnknown);
}

TEST(TrackPoints, LinkPointsOfACurveAndLeaveLoneOnesOut) {
  std::vector<EdgePoint> points;
  for (int i = 0; i < 12; ++i) {
    EdgePoint p;
    p.position = {0.03 * i, 0, 0}, p.tangent = {1, 0, 0}, p.views = 5;
    points.push_back(p);
  }
  points.push_back(points.back());
  points.back().position = {0, 5, 0};
  const CurvePoints tracks = track_points(points, 0.01, 3);
  EXPECT_EQ(tracks.first, (std::vector<int>{0, 12}));
  EXPECT_LT(tracks.position.row(1).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_EQ(track_points(points, 0.01, 13).position.cols(), 0);
}

}  // namespace
}  // namespace sketchsplat
