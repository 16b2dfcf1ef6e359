// SPDX-License-Identifier: MIT
#include "pipelines/cameras/point_prior.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "pipelines/cameras/refine_poses.h"
#include "pipelines/method/lift_and_fit.h"
#include "pipelines/options/options.h"
#include "tests/support/strokes.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::ElementsAre;
const Vector3d kMiddle(0.5, 0.5, 0.5);
constexpr double kJitter = 0.3;  // [px] of every pixel, in both directions

// Points in the unit cube, as views show them, every pixel off by as much to some side.
std::vector<ScenePoint> points_of(const std::vector<View>& views, int count, double jitter) {
  std::vector<ScenePoint> points;
  for (int i = 0; i < count; ++i) {
    ScenePoint point;
    for (int k = 0; k < 3; ++k) point.position[k] = 0.5 + 0.4 * std::sin(2.7 * i + 1.9 * k * i + k);
    for (int v = i % 2; v < int(views.size()); v += 2) {
      double depth;
      Vector2d pixel;
      views[v].image_pixel(views[v].project(point.position, &depth), &pixel);
      const Vector2d off((i + v / 2) % 2 ? jitter : -jitter, (i / 2 + v) % 3 ? jitter : -jitter);
      point.sights.push_back({v, pixel + off});
    }
    points.push_back(point);
  }
  return points;
}

// Half the weighted squared distances of the best place of every point.
double cost(const CameraUnknowns& cameras, const std::vector<ScenePoint>& points, double weight) {
  double sum = 0;
  for (const ScenePoint& point : points) {
    Vector3d x = point.position;
    double least = 0;
    for (int round = 0; round < 4; ++round) {
      Matrix3d A = Matrix3d::Zero();
      Vector3d b = Vector3d::Zero();
      least = 0;
      for (const PointSight& sight : point.sights) {
        CameraUnknowns::Derivatives by;
        Vector2d pixel;
        cameras.image(sight.view, x, &pixel, &by);
        const Vector2d r = pixel - sight.pixel;
        least += weight * r.squaredNorm() / 2;
        A += by.point.transpose() * by.point;
        b += by.point.transpose() * r;
      }
      x -= A.inverse() * b;
    }
    sum += least;
  }
  return sum;
}

TEST(PointPrior, PointsAreOffByWhatTheirPixelsAre) {
  const std::vector<View> views = ring_of_views(6, kMiddle, 3);
  EXPECT_LT(points_off_px(views, points_of(views, 40, 0)), 1e-9);
  const double jittered = points_off_px(views, points_of(views, 40, kJitter));
  EXPECT_GT(jittered, kJitter);
  EXPECT_LT(jittered, 2 * kJitter) << "as if normal";
  EXPECT_EQ(points_off_px(views, {}), 0);
}

TEST(PointPrior, GradientAndCurvatureAreThoseOfTheBestPoints) {
  std::vector<View> views = ring_of_views(6, kMiddle, 3);
  for (View& v : views) v.lens = Lens(LensModel::kOpencv, {-0.1, 0.02, 0.003, -0.002});
  const std::vector<ScenePoint> points = points_of(views, 40, kJitter);
  CameraUnknowns cameras(views, kMiddle, std::vector<double>(6, 60), {});
  const CameraQuadratic prior = point_prior(cameras, points);
  const double sigma = 1.4826 * kJitter;
  const double r2 = 2 * kJitter * kJitter / std::pow(4.685 * sigma, 2);
  const double weight = std::pow((1 - r2) / sigma, 2);
  const double scale = prior.gradient.norm(), top = prior.information.diagonal().maxCoeff();
  ASSERT_GT(scale, 0);
  constexpr double kStep = 1e-2;
  for (const int unknown : {0, 4, 14, 23, cameras.shared_column(0), cameras.size() - 1}) {
    double at[3];
    for (const int way : {-1, 0, 1}) {
      VectorXd value = VectorXd::Zero(cameras.size());
      value[unknown] = way * kStep;
      cameras.set(value);
      at[way + 1] = cost(cameras, points, weight);
    }
    EXPECT_NEAR((at[2] - at[0]) / (2 * kStep), prior.gradient[unknown], 0.02 * scale) << unknown;
    EXPECT_NEAR((at[2] - 2 * at[1] + at[0]) / (kStep * kStep), prior.information(unknown, unknown),
                0.02 * top)
        << unknown;
  }
}

TEST(PointPrior, AWorldThatMovesAsAWholeCostsNothing) {
  const std::vector<View> views = ring_of_views(6, kMiddle, 3);
  const CameraUnknowns cameras(views, kMiddle, std::vector<double>(6, 60), {});
  const CameraQuadratic prior = point_prior(cameras, points_of(views, 40, 0));
  std::vector<View> moved = views;
  constexpr double kBy = 1e-4;
  const Matrix3d turn = Eigen::AngleAxisd(kBy, Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  for (View& v : moved) {
    v.cam_from_world.translation += v.cam_from_world.rotation * Vector3d(kBy, -2 * kBy, kBy);
    v.cam_from_world.rotation = v.cam_from_world.rotation * turn;
  }
  const VectorXd x = cameras.values_of(moved);
  EXPECT_LT(x.dot(prior.information * x),
            1e-6 * x.squaredNorm() * prior.information.diagonal().maxCoeff());
  EXPECT_LT(prior.gradient.norm(), 1e-6);
}

TEST(PointPrior, APixelThatIsFarOffCountsNothing) {
  const std::vector<View> views = ring_of_views(6, kMiddle, 3);
  const CameraUnknowns cameras(views, kMiddle, std::vector<double>(6, 60), {});
  std::vector<ScenePoint> points = points_of(views, 40, 0.1);
  std::vector<ScenePoint> without = points;
  points[7].sights[1].pixel += Vector2d(30, -20);
  without[7].sights.erase(without[7].sights.begin() + 1);
  const CameraQuadratic a = point_prior(cameras, points), b = point_prior(cameras, without);
  EXPECT_LT((a.information - b.information).norm(), 1e-9 * b.information.norm());
  EXPECT_LT((a.gradient - b.gradient).norm(), 1e-9 * b.gradient.norm());
}

TEST(PointPrior, PointsFollowTheViewsThatAreLeft) {
  Scene scene;
  scene.views = ring_of_views(4, kMiddle, 3);
  for (int v = 0; v < 4; ++v) scene.views[v].name = "view " + std::to_string(v);
  const Vector2d none = Vector2d::Constant(NAN);
  scene.points = {{kMiddle, {{0, {1, 1}}, {1, {2, 2}}, {3, {3, 3}}}},
                  {kMiddle, {{1, {1, 1}}, {2, {2, 2}}}},
                  {kMiddle, {{0, {1, 1}}, {2, none}, {3, {3, 3}}}}};
  const auto left = points_among({scene.views[0], scene.views[2], scene.views[3]}, scene);
  ASSERT_EQ(left.size(), 2u) << "one view alone tells nothing";
  for (const ScenePoint& point : left) {
    ASSERT_EQ(point.sights.size(), 2u);
    EXPECT_EQ(point.sights[1].view, 2);
    EXPECT_EQ(point.sights[1].pixel, Vector2d(3, 3));
  }
  EXPECT_EQ(shrunk(left, 2)[0].sights[1].pixel, Vector2d(1.25, 1.25));
}

// Root mean square of what is left of the points' pixels when every point is where it fits best.
double misfit_px(const std::vector<View>& views, const std::vector<ScenePoint>& points) {
  CameraUnknowns cameras(views, kMiddle, std::vector<double>(views.size(), 60), {});
  double sights = 0;
  for (const ScenePoint& p : points) sights += double(p.sights.size());
  return std::sqrt(2 * cost(cameras, points, 1) / sights);
}

// Largest distance [px] of what was found from what is true.
double place_error_px(const Sketch& found, const std::vector<Polyline>& truth,
                      const std::vector<View>& views) {
  double worst = 0;
  for (int s = 0; s < found.size(); ++s)
    for (int i = 0; i <= 10; ++i)
      worst = std::max(worst, distance_to(truth, point_at(found, s, 0.1 + 0.08 * i)));
  return worst * views[0].camera.fx / (views[0].cam_from_world * kMiddle).z();
}

// Cameras that err by two pixels, and pictures of a square, which alone would let them err on.
TEST(PointPrior, PointsHoldCamerasThatAFewStrokesDoNot) {
  const std::vector<View> truth = ring_of_views(12, kMiddle, 3);
  std::vector<Polyline> square = cube_edges({0.3, 0.3, 0.3}, 0.4);
  square.resize(4);
  std::vector<EdgelMap> maps;
  Scene scene;
  for (int k = 0; k < int(truth.size()); ++k) {
    maps.push_back(ideal_edgels(truth[k], square));
    View stated = truth[k];
    stated.name = "view " + std::to_string(k);
    const Vector3d axis(std::cos(2.4 * k), std::sin(2.4 * k), 3 * std::sin(1.7 * k));
    const Matrix3d turn =
        Eigen::AngleAxisd(2 / stated.camera.fx, axis.normalized()).toRotationMatrix();
    stated.cam_from_world.rotation = turn * stated.cam_from_world.rotation;
    stated.cam_from_world.translation = turn * stated.cam_from_world.translation;
    scene.views.push_back(stated);
  }
  const std::vector<ScenePoint> points = points_of(truth, 60, 0.05);
  ReconstructOptions options;
  options.refine_poses = "on";
  RunReport report;
  const EdgeWorld world = make_edge_world(scene.views, maps);
  const double before = misfit_px(scene.views, points);
  const PosedStrokes alone = pose_and_fit(scene, world, lift_and_fit, {options, {&report}});
  scene.points = points;
  const PosedStrokes held = pose_and_fit(scene, world, lift_and_fit, {options, {&report}});
  ASSERT_TRUE(held.refined);
  EXPECT_LT(misfit_px(held.world.views, points), 0.15);
  EXPECT_GT(before, 0.8);
  EXPECT_GT(misfit_px(alone.world.views, points), 0.3);
  EXPECT_LT(place_error_px(held.sketch, square, truth), 0.1) << "where the points are";
}

}  // namespace
}  // namespace sketchsplat
