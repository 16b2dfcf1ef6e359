// SPDX-License-Identifier: MIT
#include "pipelines/cameras/refine_poses.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <fstream>

#include "datasets/readers/scene.h"
#include "datasets/types/dense.h"
#include "datasets/types/errors.h"
#include "datasets/types/median.h"
#include "pipelines/cameras/camera_unknowns.h"
#include "pipelines/method/lift_and_fit.h"
#include "pipelines/options/options.h"
#include "tests/pipelines/rendered_part.h"
#include "tests/support/house.h"
#include "tests/support/strokes.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

// Turned and shifted so that the object moves by some pixels, another way in each view.
View jogged(View v, int k, double px) {
  const double angle = px / v.camera.fx;
  const Vector3d axis(std::cos(2.4 * k), std::sin(2.4 * k), 3 * std::sin(1.7 * k));
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  v.cam_from_world.rotation = turn * v.cam_from_world.rotation;
  v.cam_from_world.translation = turn * v.cam_from_world.translation;
  return v;
}

std::vector<View> jogged(std::vector<View> views, double px) {
  for (size_t k = 0; k < views.size(); ++k) views[k] = jogged(views[k], int(k), px);
  return views;
}

PosedStrokes posed(const std::vector<View>& stated, const std::vector<View>& truth,
                   RunReport* report, const std::string& how = "auto") {
  ReconstructOptions options;
  options.refine_poses = how;
  return pose_and_fit({}, make_edge_world(stated, house_edgels(truth)), lift_and_fit,
                      {options, {report}});
}

// Of sides and diagonals of what was found to what is true: largest distance after a shift, turn
// and scale.
double shape_error(const Sketch& found) {
  const std::vector<Polyline> truth = house();
  Eigen::Matrix3Xd from(3, 0), to(3, 0);
  for (int s = 0; s < found.size(); ++s)
    for (int i = 0; i <= 10; ++i) {
      const Vector3d p = point_at(found, s, 0.1 + 0.08 * i);
      Vector3d best = Vector3d::Zero();
      double least = 1e300;
      for (const Polyline& c : truth) {
        const Vector3d d = c[1] - c[0];
        const Vector3d q = c[0] + std::clamp(d.dot(p - c[0]) / d.squaredNorm(), 0.0, 1.0) * d;
        if ((q - p).norm() < least) least = (q - p).norm(), best = q;
      }
      from.conservativeResize(3, from.cols() + 1), to.conservativeResize(3, to.cols() + 1);
      from.col(from.cols() - 1) = p, to.col(to.cols() - 1) = best;
    }
  const Eigen::Matrix4d T = similarity_between(from, to);
  double worst = 0;
  for (int i = 0; i < from.cols(); ++i)
    worst = std::max(worst, distance_to(truth, (T * from.col(i).homogeneous()).hnormalized()));
  return worst;
}

// Median distance [px of the first view] of what was found from what is true, where it lies.
double place_error_px(const Sketch& found, const std::vector<View>& views) {
  std::vector<double> off;
  for (int s = 0; s < found.size(); ++s)
    for (int i = 0; i <= 10; ++i)
      off.push_back(distance_to(house(), point_at(found, s, 0.1 + 0.08 * i)));
  return median(off) * views[0].camera.fx / (views[0].cam_from_world * kHouseMiddle).z();
}

TEST(RefinePoses, CamerasThatTurnedAboutThemselvesLeaveThePartWhereTheirCentresSay) {
  const std::vector<View> truth = ring_of_views(20, kHouseMiddle, 3);
  RunReport report;
  const PosedStrokes out = posed(jogged(truth, 2), truth, &report);
  ASSERT_TRUE(out.refined);
  EXPECT_LT(place_error_px(out.sketch, truth), 0.2);
}

TEST(CameraUnknowns, DerivativesAreThoseOfDifferences) {
  std::vector<View> views = ring_of_views(4, kHouseMiddle, 3);
  for (View& v : views) {
    v.camera.fy = 510;
    v.lens = Lens(LensModel::kOpencv, {-0.1, 0.02, 0.003, -0.002});
  }
  CameraUnknowns cameras(views, kHouseMiddle, {60, 60, 60, 60}, {});
  ASSERT_EQ(cameras.cameras(), 1);
  EXPECT_EQ(cameras.size(), 4 * 6 + 8) << "focal length, aspect, centre and four terms";
  const Vector3d point(0.7, 0.3, 0.6);
  CameraUnknowns::Derivatives by;
  Vector2d at;
  ASSERT_TRUE(cameras.image(2, point, &at, &by));
  constexpr double kStep = 1e-4;
  const auto difference = [&](int unknown) {
    Vector2d q[2];
    for (const int sign : {-1, 1}) {
      VectorXd value = VectorXd::Zero(cameras.size());
      value[unknown] = sign * kStep;
      cameras.set(value);
      cameras.image(2, point, &q[sign > 0]);
    }
    return Vector2d((q[1] - q[0]) / (2 * kStep));
  };
  for (int k = 0; k < 6; ++k)
    EXPECT_LT((difference(cameras.pose_column(2) + k) - by.pose.col(k)).norm(), 1e-6) << k;
  for (int k = 0; k < cameras.num_shared(0); ++k)
    EXPECT_LT((difference(cameras.shared_column(0) + k) - by.shared.col(k)).norm(), 1e-6) << k;
  cameras.set(VectorXd::Zero(cameras.size()));
  for (int k = 0; k < 3; ++k) {
    Vector2d a, b;
    cameras.image(2, point + 1e-6 * Vector3d::Unit(k), &a);
    cameras.image(2, point - 1e-6 * Vector3d::Unit(k), &b);
    EXPECT_LT(((a - b) / 2e-6 - by.point.col(k)).norm(), 1e-3) << k;
  }
}

TEST(CameraUnknowns, ValuesMakeTheCamerasThatTheyAreMadeOf) {
  const std::vector<View> views = ring_of_views(3, kHouseMiddle, 3);
  CameraUnknowns cameras(views, kHouseMiddle, {60, 60, 60}, {});
  VectorXd value(cameras.size());
  for (int k = 0; k < value.size(); ++k) value[k] = std::sin(k + 1.0);
  cameras.set(value);
  EXPECT_LT((cameras.values_of(cameras.current()) - value).norm(), 1e-8);
}

TEST(CameraUnknowns, WhatViewsShareStaysIfItIsNoUnknown) {
  std::vector<View> views = ring_of_views(3, kHouseMiddle, 3);
  for (View& v : views) v.lens = Lens(LensModel::kOpencv, {-0.1, 0.02, 0.003, -0.002});
  CameraPrior prior;
  prior.shared = false;
  CameraUnknowns cameras(views, kHouseMiddle, {60, 60, 60}, prior);
  EXPECT_EQ(cameras.size(), 3 * 6);
  EXPECT_EQ(cameras.num_shared(0), 0);
  cameras.set(VectorXd::Ones(cameras.size()));
  EXPECT_EQ(cameras.current()[1].camera.fx, views[1].camera.fx);
  EXPECT_EQ(cameras.current()[1].lens.terms().k1, -0.1);
  CameraUnknowns::Derivatives by;
  Vector2d at;
  EXPECT_TRUE(cameras.image(1, {0.7, 0.3, 0.6}, &at, &by));
}

TEST(RefinePoses, ExactCamerasAreLeftAlone) {
  const std::vector<View> views = ring_of_views(20, kHouseMiddle, 3);
  RunReport a, b;
  const PosedStrokes untouched = posed(views, views, &a);
  EXPECT_FALSE(untouched.refined);
  EXPECT_EQ(json_of(untouched.sketch), json_of(posed(views, views, &b, "off").sketch));
  EXPECT_THAT(a.warnings, testing::IsEmpty());
}

TEST(RefinePoses, EdgesThatErrByThemselvesAreNoReasonToMoveExactCameras) {
  const std::vector<View> views = ring_of_views(20, kHouseMiddle, 3);
  std::vector<EdgelMap> maps = house_edgels(views);
  for (size_t v = 0; v < maps.size(); ++v)
    for (int c = 0; c < maps[v].num_chains(); ++c) {
      const double off =
          0.4 * std::sin(7.0 * c + 3.0 * double(v * v));  // [px] of an edge in a view
      for (int i = maps[v].chain[c]; i < maps[v].chain[c + 1]; ++i) {
        Edgel& e = maps[v].edgels[i];
        e.x += float(off * e.nx), e.y += float(off * e.ny);
      }
    }
  const ReconstructOptions options;
  RunReport report;
  EXPECT_FALSE(
      pose_and_fit({}, make_edge_world(views, maps), lift_and_fit, {options, {&report}}).refined);
}

TEST(RefinePoses, CamerasThatErrComeBack) {
  const std::vector<View> truth = ring_of_views(20, kHouseMiddle, 3);
  for (const double px : {0.7, 2.0, 3.0}) {
    RunReport report, other;
    const std::vector<View> stated = jogged(truth, px);
    const PosedStrokes out = posed(stated, truth, &report);
    ASSERT_TRUE(out.refined) << px;
    EXPECT_EQ(out.world.views.size(), truth.size()) << px;
    EXPECT_GE(out.sketch.size(), 20) << px;
    EXPECT_LT(shape_error(out.sketch), 0.003) << px;  // half a pixel
  }
}

TEST(RefinePoses, PosesThatErrChangeNeitherScaleNorPlace) {
  const std::vector<View> truth = ring_of_views(20, kHouseMiddle, 3);
  RunReport report;
  const PosedStrokes out = posed(jogged(truth, 2), truth, &report);
  ASSERT_TRUE(out.refined);
  EXPECT_NEAR(out.world.views[0].camera.fx, truth[0].camera.fx, 0.5);
  double worst = 0;
  for (int s = 0; s < out.sketch.size(); ++s)
    for (const double t : {0.1, 0.5, 0.9})
      worst = std::max(worst, distance_to(house(), point_at(out.sketch, s, t)));
  EXPECT_LT(worst, 0.006) << "one pixel, where single cameras err by two";
}

// Whether other cameras are tried for a house that stands on a table, with points whose pixels are
// off by so much to some side.
bool tries_others_on_table(double off_px) {
  const std::vector<View> views = ring_of_views(20, kHouseMiddle, 3);
  Scene scene;
  scene.views = views;
  for (int i = 0; i < 60; ++i) {
    ScenePoint point;
    for (int k = 0; k < 3; ++k) point.position[k] = 0.5 + 0.4 * std::sin(2.7 * i + 1.9 * k * i + k);
    for (int v = 0; v < int(views.size()); ++v) {
      double depth;
      const Vector2d off((i + v) % 2 ? off_px : -off_px, (i + v / 2) % 3 ? off_px : -off_px);
      point.sights.push_back({v, views[v].project(point.position, &depth) + off});
    }
    scene.points.push_back(point);
  }
  EdgeWorld world = make_edge_world(views, house_edgels(views));
  world.object.table.emplace(Vector3d::UnitZ(), -0.2);
  RunReport report;
  pose_and_fit(scene, world, lift_and_fit, {ReconstructOptions(), {&report}});
  return std::any_of(report.counts.begin(), report.counts.end(),
                     [](const auto& count) { return count.first == "pose_offset_after_px"; });
}

TEST(RefinePoses, AmongThingsPointsThatLieBesideTheirPixelsAreReasonEnough) {
  EXPECT_TRUE(tries_others_on_table(0.4));
  EXPECT_FALSE(tries_others_on_table(0));
}

TEST(RefinePoses, AWrongFocalLengthIsFound) {
  const std::vector<View> truth = ring_of_views(20, kHouseMiddle, 3);
  std::vector<View> stated = truth;
  for (View& v : stated) v.camera.fx *= 1.02, v.camera.fy *= 1.02;
  RunReport report;
  const PosedStrokes out = posed(stated, truth, &report);
  ASSERT_TRUE(out.refined);
  EXPECT_NEAR(out.world.views[0].camera.fx, truth[0].camera.fx, 0.003 * truth[0].camera.fx);
}

TEST(RefinePoses, AViewThatContradictsTheOthersIsNamedAndLeftOut) {
  const std::vector<View> truth = ring_of_views(20, kHouseMiddle, 3);
  std::vector<View> stated = truth;
  stated[7] = jogged(truth[7], 7, 40);
  RunReport report;
  const PosedStrokes out = posed(stated, truth, &report);
  EXPECT_EQ(out.world.views.size(), 19u);
  ASSERT_THAT(report.warnings, testing::SizeIs(1));
  EXPECT_THAT(report.warnings[0], testing::EndsWith(": 7"));
}

TEST(RefinePoses, CamerasInTheWrongOrderAreRefused) {
  const std::vector<View> truth = ring_of_views(20, kHouseMiddle, 3);
  std::vector<View> stated = truth;
  for (size_t k = 0; k < stated.size(); ++k) {
    stated[k].cam_from_world = truth[(7 * k + 3) % 20].cam_from_world;
    stated[k] = jogged(stated[k], int(k), 20);
  }
  RunReport report;
  EXPECT_THROW(posed(stated, truth, &report), TooLittleError);
}

TEST(RefinePoses, RenderedPosesInTheWrongOrderAreRefusedInOneLine) {
  const TempFolder folder;
  SynthesizeOptions part;
  part.part = "l-bracket";
  part.rig.views = 16, part.rig.resolution = 300;
  part.outputs = "none";
  write_scene(synthesize(part), folder.path());
  Scene scene = open_scene(folder.path());
  const std::vector<View> truth = scene.views;
  for (size_t k = 0; k < truth.size(); ++k)
    scene.views[k].cam_from_world = truth[(7 * k + 3) % truth.size()].cam_from_world;
  try {
    reconstruct_as_ever(scene);
    ADD_FAILURE() << "curves of poses that belong to other images";
  } catch (const TooLittleError& e) {
    EXPECT_THAT(e.what(), testing::EndsWith("poses and images contradict each other"));
  }
}

// A rod of 48 flat faces, 15 times as long as it is thick.
void write_rod(const std::string& path) {
  constexpr int kSides = 48;
  std::ofstream out(path);
  for (int k = 0; k < 2 * kSides; ++k) {
    const double angle = 2 * M_PI * k / kSides;
    out << "v " << std::cos(angle) / 15 << ' ' << std::sin(angle) / 15 << ' ' << k / kSides << '\n';
  }
  for (int k = 0; k < kSides; ++k) {
    const int a = k + 1, b = (k + 1) % kSides + 1;
    out << "f " << a << ' ' << b << ' ' << b + kSides << ' ' << a + kSides << '\n';
  }
  for (const int top : {0, 1}) {
    out << 'f';
    for (int k = 0; k < kSides; ++k) out << ' ' << (top ? kSides + k + 1 : kSides - k);
    out << '\n';
  }
}

// Nearly all edges of its images are spots and contours, and it looks alike a bit aside.
TEST(RefinePoses, PhotographsOfASpeckledRodContradictNothing) {
  const TempFolder folder;
  write_rod(folder.path() + "/rod.obj");
  SynthesizeOptions part;
  part.part = folder.path() + "/rod.obj";
  part.seed = 2;
  part.rig.views = 24, part.rig.resolution = 320;
  part.render.style = Style::kPhoto;
  part.render.noise = 2;
  part.photo.surface = Finish::kSpeckled;
  write_scene(synthesize(part), folder.path() + "/scene");
  const Sketch found = reconstruct_as_ever(open_scene(folder.path() + "/scene")).sketch;
  EXPECT_GT(f_at(score(found, folder.path() + "/scene").fine, 0.005), 60) << "one of two rims";
}

TEST(RefinePoses, ARenderedPartWithPoseNoiseLosesLittle) {
  const TempFolder folder;
  SynthesizeOptions part;
  part.part = "l-bracket";
  part.rig.views = 24, part.rig.resolution = 400;
  part.render.noise = 2;
  part.outputs = "none";
  part.degrade.pose_noise_px = 1;
  write_scene(synthesize(part), folder.path());
  ReconstructOptions off;
  off.refine_poses = "off";
  const Scene scene = open_scene(folder.path());
  const Reconstruction refined = reconstruct_as_ever(scene);
  ASSERT_EQ(refined.refined.size(), 24u);
  const double better = f_at(score(refined.sketch, folder.path()).fine, 0.005);
  EXPECT_GT(better,
            f_at(score(reconstruct(scene, off, nullptr).sketch, folder.path()).fine, 0.005));
}

// All that tells of its cameras are two strokes.
TEST(RefinePoses, ARenderedPartOfTwoEdgesTellsItsFocalLength) {
  for (const int seed : {0, 1}) {
    const TempFolder folder;
    SynthesizeOptions part;
    part.part = "cut-cylinder";
    part.seed = seed;
    part.rig.views = 24, part.rig.resolution = 400;
    part.render.noise = 2;
    part.outputs = "none";
    part.degrade.focal_error_percent = 2;
    write_scene(synthesize(part), folder.path());
    const Sketch found = reconstruct_as_ever(open_scene(folder.path())).sketch;
    EXPECT_GT(f_at(score(found, folder.path()).fine, 0.005), 98.5) << seed;
  }
}

}  // namespace
}  // namespace sketchsplat
