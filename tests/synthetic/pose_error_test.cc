// SPDX-License-Identifier: MIT
#include "datasets/synthetic/render/pose_error.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "datasets/synthetic/render/noise.h"
#include "datasets/synthetic/render/rig.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector2d;
using Eigen::Vector3d;

std::vector<View> cameras(int n, bool lens) {
  RigOptions options;
  options.views = n;
  std::vector<View> views = make_rig(resolved(options, /*photographs=*/true), 3);
  if (lens)
    for (View& view : views) view.lens = Lens(LensModel::kOpencv, {-0.1, 0.03, 4e-4, -2e-4});
  return views;
}

Matrix3Xd cube() {
  Matrix3Xd points(3, 200);
  for (int i = 0; i < points.cols(); ++i)
    for (int c = 0; c < 3; ++c) points(c, i) = uniform(hash(1, i, c, 0)) - 0.5;
  return points;
}

Vector2d shift_of(const View& a, const View& b, const Vector3d& p) {
  double depth;
  Vector2d pa, pb;
  EXPECT_TRUE(a.image_pixel(a.project(p, &depth), &pa));
  EXPECT_TRUE(b.image_pixel(b.project(p, &depth), &pb));
  return pb - pa;
}

double rms(const std::vector<View>& a, const std::vector<View>& b, const Matrix3Xd& points) {
  double sum = 0;
  for (size_t k = 0; k < a.size(); ++k)
    for (int i = 0; i < points.cols(); ++i)
      sum += shift_of(a[k], b[k], points.col(i)).squaredNorm();
  return std::sqrt(sum / double(a.size() * points.cols()));
}

TEST(PoseError, HasTheStatedSize) {
  for (bool lens : {false, true})
    for (double px : {0.1, 0.6, 3.0}) {
      const std::vector<View> views = cameras(24, lens);
      const std::vector<View> err = with_pose_error(views, cube(), px, 7);
      EXPECT_NEAR(rms(views, err, cube()), px, 0.02 * px);
      EXPECT_NEAR(rms_shift(views, err, cube()), px, 0.02 * px);
    }
  const std::vector<View> views = cameras(4, true);
  EXPECT_EQ(rms(views, with_pose_error(views, cube(), 0, 7), cube()), 0);
}

TEST(PoseError, OneCameraModelIsWrongForAllAlike) {
  const std::vector<View> views = cameras(12, true), err = with_pose_error(views, cube(), 0.6, 7);
  for (const View& view : err) {
    EXPECT_EQ(view.camera.fx, err[0].camera.fx);
    EXPECT_EQ(view.camera.cx, err[0].camera.cx);
    EXPECT_EQ(view.lens.terms().k1, err[0].lens.terms().k1);
    EXPECT_LT((view.cam_from_world.rotation * view.cam_from_world.rotation.transpose() -
               Eigen::Matrix3d::Identity())
                  .norm(),
              1e-12);
  }
  EXPECT_NE(err[0].camera.fx, views[0].camera.fx);
  EXPECT_NE(err[0].camera.cx, views[0].camera.cx);
  EXPECT_NE(err[0].lens.terms().k1, views[0].lens.terms().k1);
}

Vector3d turn_between(const View& a, const View& b) {
  const Eigen::AngleAxisd turn(
      Eigen::Matrix3d(b.cam_from_world.rotation.transpose() * a.cam_from_world.rotation));
  return turn.angle() * turn.axis();
}

// What tells it from white noise.
TEST(PoseError, NeighboursShareIt) {
  double near = 0, far = 0, all = 0;
  int n_near = 0, n_far = 0, n = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const std::vector<View> views = cameras(40, true);
    const std::vector<View> err = with_pose_error(views, cube(), 0.6, seed);
    std::vector<Vector3d> turns, places;
    for (size_t k = 0; k < views.size(); ++k) {
      turns.push_back(turn_between(views[k], err[k]));
      places.push_back(views[k].center_in_world().normalized());
      all += turns[k].squaredNorm(), ++n;
    }
    for (size_t i = 0; i < views.size(); ++i)
      for (size_t j = 0; j < i; ++j) {
        const double cosine = places[i].dot(places[j]);
        if (cosine > std::cos(0.45)) near += turns[i].dot(turns[j]), ++n_near;
        if (cosine < 0) far += turns[i].dot(turns[j]), ++n_far;
      }
  }
  ASSERT_GT(n_near, 100);
  EXPECT_GT(near / n_near, 0.6 * all / n);
  EXPECT_LT(far / n_far, 0.2 * all / n);
}

// Nothing of it is a similarity of the world: curves lie where the truth is.
TEST(PoseError, DoesNotMoveTheWorld) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const std::vector<View> views = cameras(24, true);
    const std::vector<View> err = with_pose_error(views, cube(), 1, seed);
    Matrix3Xd moved = cube();
    const double before = rms(views, err, moved);
    const auto error_with = [&](double scale, const Vector3d& shift, const Eigen::Matrix3d& turn) {
      double sum = 0;
      for (size_t k = 0; k < views.size(); ++k)
        for (int i = 0; i < moved.cols(); ++i) {
          const Vector3d p = moved.col(i), q = scale * turn * p + shift;
          double depth;
          Vector2d a, b;
          EXPECT_TRUE(views[k].image_pixel(views[k].project(p, &depth), &a));
          EXPECT_TRUE(err[k].image_pixel(err[k].project(q, &depth), &b));
          sum += (a - b).squaredNorm();
        }
      return std::sqrt(sum / double(views.size() * moved.cols()));
    };
    const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
    for (double step : {-1e-3, 1e-3}) {
      EXPECT_GT(error_with(1 + step, Vector3d::Zero(), I), 0.999 * before);
      for (int c = 0; c < 3; ++c) {
        EXPECT_GT(error_with(1, step * Vector3d::Unit(c), I), 0.999 * before);
        const Eigen::Matrix3d turn = Eigen::AngleAxisd(step, Vector3d::Unit(c)).toRotationMatrix();
        EXPECT_GT(error_with(1, Vector3d::Zero(), turn), 0.999 * before);
      }
    }
  }
}

TEST(PoseError, MoreOfItIsAboutTheSameErrorScaled) {
  const std::vector<View> views = cameras(10, true);
  const std::vector<View> one = with_pose_error(views, cube(), 0.3, 5),
                          two = with_pose_error(views, cube(), 0.6, 5);
  double difference = 0, size = 0;
  for (size_t k = 0; k < views.size(); ++k) {
    const Vector2d a = shift_of(views[k], one[k], Vector3d(0.3, 0.1, -0.2)),
                   b = shift_of(views[k], two[k], Vector3d(0.3, 0.1, -0.2));
    difference += (b - 2 * a).squaredNorm();
    size += b.squaredNorm();
  }
  EXPECT_LT(difference, 0.01 * size);
}

}  // namespace
}  // namespace sketchsplat
