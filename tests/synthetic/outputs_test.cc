// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "datasets/io/float_image_io.h"
#include "datasets/io/image_io.h"
#include "datasets/synthetic/render/visibility.h"
#include "datasets/synthetic/scene/synthesize.h"
#include "datasets/types/errors.h"
#include "tests/datasets/temp_folder.h"

namespace sketchsplat {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

SynthesizeOptions small(const std::string& part) {
  SynthesizeOptions options;
  options.part = part;
  options.rig.views = 3;
  options.rig.resolution = 200;
  options.rig.object_size = 0.6;
  return options;
}

double distance_to_segment(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d ab = b - a;
  const double t = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
  return (p - a - t * ab).norm();
}

TEST(Outputs, OnlyThoseAskedForAreWritten) {
  SynthesizeOptions options = small("box");
  options.rig.resolution = 32;
  for (const std::string asked : {"none", "mask", "depth,edges", "all"}) {
    const TempFolder folder;
    options.outputs = asked;
    write_scene(synthesize(options), folder.path());
    const auto expected = [&](const char* name) {
      return asked == "all" || asked.find(name) != std::string::npos;
    };
    const auto there = [&](const char* file) {
      return std::filesystem::exists(folder.path() + file);
    };
    EXPECT_EQ(there("/mask/2.png"), expected("mask")) << asked;
    EXPECT_EQ(there("/depth/2.exr"), expected("depth")) << asked;
    EXPECT_EQ(there("/normal/2.exr"), expected("normal")) << asked;
    EXPECT_EQ(there("/edges_visible/2.png"), expected("edges")) << asked;
    EXPECT_EQ(there("/edges_visible/2.json"), expected("edges")) << asked;
  }
  EXPECT_THROW(parse_outputs("mask,dept"), InputError);
  EXPECT_THROW(parse_outputs(""), InputError);
}

// One ray at a time, through pixels found by projection rather than by Camera::ray.
TEST(Outputs, DepthAndNormalFilesAgreeWithCastRays) {
  const TempFolder folder;
  SynthesizeOptions options = small("box-fillet");
  options.extent = 250;
  options.render.noise = 9;
  options.render.blur = 2;  // of the image alone
  options.outputs = "depth,normal,mask";
  const SyntheticScene scene = synthesize(options);
  write_scene(scene, folder.path());
  const auto depth = read_exr(folder.path() + "/depth/1.exr");
  const auto normal = read_exr(folder.path() + "/normal/1.exr");
  ASSERT_EQ(depth.size(), 1u);
  ASSERT_EQ(normal.size(), 3u);
  const View& view = scene.views[1];
  const Vector3d eye = scene.unit_views[1].center_in_world();
  int hits = 0;
  for (int y = 0; y < 200; y += 3)
    for (int x = 0; x < 200; x += 3) {
      const float z = depth[0].values.at(x, y);
      const Vector3d in_cam(normal[0].values.at(x, y), normal[1].values.at(x, y),
                            normal[2].values.at(x, y));
      const Vector3d far =
          view.cam_from_world.inverse() *
          Vector3d((x - 99.5) / view.camera.fx * 1e4, (y - 99.5) / view.camera.fy * 1e4, 1e4);
      const Vector3d direction = (far / 250 - Vector3d::Constant(0.5) - eye).normalized();
      const Hit hit = scene.tracer.cast(eye.cast<float>(), direction.cast<float>());
      EXPECT_TRUE(z > 0 || in_cam.isZero());
      if (hit.face < 0 || z == 0) continue;  // rays along the very outline may disagree
      ++hits;
      const Vector3d point = eye + direction * hit.depth;
      double expected;
      view.project((point + Vector3d::Constant(0.5)) * 250, &expected);
      EXPECT_NEAR(z, expected, 0.02);
      const Vector3d in_world = view.cam_from_world.rotation.transpose() * in_cam;
      EXPECT_NEAR(in_cam.norm(), 1, 2e-3);
      EXPECT_LT((in_world - hit.normal.cast<double>()).norm(), 0.01);
      EXPECT_LT(in_cam.dot(Vector3d((x - 99.5) / view.camera.fx, (y - 99.5) / view.camera.fy, 1)),
                1e-3);
    }
  EXPECT_GT(hits, 200);
  const Image<float> mask = read_grey(folder.path() + "/mask/1.png");
  int wrong = 0;
  for (size_t i = 0; i < mask.data.size(); ++i)
    wrong += (mask.data[i] == 1 && depth[0].values.data[i] == 0) ||
             (mask.data[i] == 0 && depth[0].values.data[i] > 0);
  EXPECT_EQ(wrong, 0);
}

TEST(EdgesVisible, LieOnTheProjectedTruthInStepsOfAPixel) {
  const TempFolder folder;
  SynthesizeOptions options = small("flange");
  options.outputs = "edges";
  const SyntheticScene scene = synthesize(options);
  write_scene(scene, folder.path());
  for (int k = 0; k < 3; ++k) {
    const auto json = nlohmann::json::parse(
        std::ifstream(folder.path() + "/edges_visible/" + std::to_string(k) + ".json"));
    ASSERT_EQ(json["polylines"].size(), json["curve"].size());
    ASSERT_GT(json["curve"].size(), 3u);
    for (size_t n = 0; n < json["curve"].size(); ++n) {
      const TruthCurve& curve = scene.truth.curves.at(json["curve"][n].get<size_t>());
      Vector2d before(NAN, NAN);
      for (const auto& xy : json["polylines"][n]) {
        const Vector2d p(xy[0], xy[1]);
        EXPECT_TRUE(before.hasNaN() || (p - before).norm() < 1.1);
        before = p;
        double nearest = 1e9, depth;
        for (int i = 1; i < curve.points.cols(); ++i)
          nearest = std::min(
              nearest,
              distance_to_segment(p, scene.views[k].project(curve.points.col(i - 1), &depth),
                                  scene.views[k].project(curve.points.col(i), &depth)));
        EXPECT_LT(nearest, 0.03);
      }
    }
  }
}

// A box is convex: an edge is seen whole if one of its two faces looks at the camera, else not.
TEST(EdgesVisible, EdgesOfABoxAreThereWholeOrNotAtAll) {
  SynthesizeOptions options = small("box");
  options.rig.views = 20;
  const SyntheticScene scene = synthesize(options);
  Eigen::AlignedBox3d box;
  for (int n = 0; n < 8; ++n) box.extend(Vector3d(scene.truth.sketch.nodes.col(n)));
  int hidden = 0;
  for (size_t k = 0; k < scene.views.size(); ++k) {
    const VisibleEdges edges =
        visible_edges(scene.unit_views[k], scene.tracer, scene.unit_curves, scene.lift);
    std::vector<double> length(scene.truth.curves.size());
    for (size_t n = 0; n < edges.curve.size(); ++n)
      for (int i = 1; i < edges.polylines[n].cols(); ++i)
        length[edges.curve[n]] +=
            (edges.polylines[n].col(i) - edges.polylines[n].col(i - 1)).norm();
    const Vector3d eye = scene.views[k].center_in_world();
    for (size_t c = 0; c < length.size(); ++c) {
      const auto& points = scene.truth.curves[c].points;
      const Vector3d middle = points.col(points.cols() / 2);
      bool seen = false, grazing = false;
      for (int axis = 0; axis < 3; ++axis) {
        seen |= std::abs(middle[axis] - box.max()[axis]) < 1e-9 && eye[axis] > box.max()[axis];
        seen |= std::abs(middle[axis] - box.min()[axis]) < 1e-9 && eye[axis] < box.min()[axis];
        grazing |= std::abs(eye[axis] - box.max()[axis]) < 0.4;
        grazing |= std::abs(eye[axis] - box.min()[axis]) < 0.4;
      }
      double depth;
      const double full = (scene.views[k].project(points.rightCols<1>(), &depth) -
                           scene.views[k].project(points.leftCols<1>(), &depth))
                              .norm();
      // Rays start above the edge: they pass a face seen from the side, and the nearest corner.
      if (full < 1 || grazing) continue;
      EXPECT_NEAR(length[c], seen ? full : 0, 0.6) << "view " << k << ", edge " << c;
      hidden += !seen;
    }
  }
  EXPECT_GE(hidden, 20);
}

TEST(EdgesVisible, DrawingHasItsCentreOnTheLineAndAboutAPixelOfWidth) {
  VisibleEdges edges;
  Eigen::Matrix2Xd line(2, 2);
  line << 2.0, 17.0, 5.3, 9.8;
  edges.polylines = {line};
  edges.curve = {0};
  const Image<float> image = draw(edges, 20, 16);
  for (int x = 5; x <= 14; ++x) {
    double sum = 0, moment = 0;
    for (int y = 0; y < 16; ++y) {
      sum += image.at(x, y);
      moment += y * image.at(x, y);
    }
    EXPECT_NEAR(moment / sum, 5.3 + 0.3 * (x - 2), 0.06);
    EXPECT_NEAR(sum, std::hypot(1, 0.3), 0.1);
  }
}

}  // namespace
}  // namespace sketchsplat
