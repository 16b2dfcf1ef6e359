// SPDX-License-Identifier: MIT
// The whole method on the same pictures with and without a lens.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "datasets/types/errors.h"
#include "sketches/curve/curve.h"
#include "tests/pipelines/rendered_part.h"
#include "tests/support/colmap_files.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT

const std::vector<double> kTerms = {-0.28, 0.09, 0.004, -0.003};  // 25 px at the corners

// The picture as a camera with this lens would take it: colours times alpha, resampled.
Picture bend(const Picture& straight, const View& view) {
  const int w = straight.width(), h = straight.height();
  cv::Mat2f from(h, w);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      Eigen::Vector2d ideal(-9, -9);
      view.ideal_pixel({double(x), double(y)}, &ideal);
      from(y, x) = cv::Vec2f(float(ideal.x()), float(ideal.y()));
    }
  const auto resampled = [&](Image<float> in, bool weigh) {
    for (size_t i = 0; weigh && i < in.data.size(); ++i) in.data[i] *= straight.alpha.data[i];
    Image<float> out(w, h);
    cv::Mat1f to(h, w, out.data.data());
    cv::remap(cv::Mat1f(h, w, in.data.data()), to, from, cv::noArray(), cv::INTER_LANCZOS4);
    return out;
  };
  Picture out;
  out.alpha = resampled(straight.alpha, false);
  out.red = resampled(straight.red, true);
  out.green = resampled(straight.green, true);
  out.blue = resampled(straight.blue, true);
  for (Image<float>* colour : {&out.red, &out.green, &out.blue})
    for (size_t i = 0; i < out.alpha.data.size(); ++i)
      if (out.alpha.data[i] > 0.02f) colour->data[i] /= out.alpha.data[i];
  return out;
}

// Share of samples on one sketch that lie within a distance of the other.
double covered(const Sketch& a, const Sketch& b, double distance) {
  const auto points = [](const Sketch& s) {
    std::vector<Eigen::Vector3d> out;
    for (int i = 0; i < s.size(); ++i) {
      const Eigen::Matrix3Xd p = sample_stroke(s, i, 0.002);
      for (int k = 0; k < p.cols(); ++k) out.push_back(p.col(k));
    }
    return out;
  };
  const std::vector<Eigen::Vector3d> p = points(a), q = points(b);
  int near = 0;
  for (const Eigen::Vector3d& x : p)
    near += std::any_of(q.begin(), q.end(), [&](const Eigen::Vector3d& y) {
      return (x - y).squaredNorm() < distance * distance;
    });
  return p.empty() ? 0 : double(near) / double(p.size());
}

// A part, and the same pictures as a lens would have drawn them, as a model of COLMAP.
struct BentPart {
  TempFolder folder, bent;
  Scene straight_scene, bent_scene;
  BentPart(int views, int resolution) {
    write_part("box-hole", views, resolution, 2, folder.path());
    straight_scene = open_scene(folder.path());
    write_colmap_binary(colmap_of(straight_scene, kTerms), bent.path() + "/sparse/0");
    Lens::Terms terms;
    terms.k1 = kTerms[0], terms.k2 = kTerms[1], terms.p1 = kTerms[2], terms.p2 = kTerms[3];
    for (View view : straight_scene.views) {
      view.lens = Lens(LensModel::kOpencv, terms);
      write_png(bent.file("images/" + view.name), bend(read_picture(view), view));
    }
    bent_scene = open_scene(bent.path());
  }
};

ReconstructOptions fast() {
  ReconstructOptions options;
  apply_preset("fast", &options);
  return options;
}

TEST(LensScene, ALensChangesThePicturesButNotTheCurves) {
  const BentPart part(30, 400);
  const Sketch straight = reconstruct(part.straight_scene, fast(), nullptr).sketch;
  ASSERT_EQ(part.bent_scene.views.size(), part.straight_scene.views.size());
  const Sketch curves = reconstruct(part.bent_scene, fast(), nullptr).sketch;
  EXPECT_EQ(curves.size(), straight.size());
  EXPECT_GT(covered(straight, curves, 0.003), 0.99);
  EXPECT_GT(covered(curves, straight, 0.003), 0.99);

  // The same curves are not there for those who do not know the lens, unless cameras may move.
  Scene forgotten = part.bent_scene;
  for (View& view : forgotten.views) view.lens = Lens();
  ReconstructOptions fixed = fast();
  fixed.refine_poses = "off";
  EXPECT_LT(covered(straight, reconstruct(forgotten, fixed, nullptr).sketch, 0.003), 0.85);
  EXPECT_GT(covered(straight, reconstruct(forgotten, fast(), nullptr).sketch, 0.003), 0.9);
}

TEST(LensScene, SurfelsAreFittedToPicturesWithoutIt) {
  const BentPart part(20, 300);
  ReconstructOptions options = fast();
  options.detector = "2dgs-sn";
  const Sketch curves = reconstruct(part.bent_scene, options, nullptr).sketch;
  EXPECT_GT(f_at(score(curves, part.folder.path()).fine, 0.005), 85);
}

TEST(LensScene, DepthMapsOfViewsWithDistortionAreRefused) {
  const BentPart part(3, 64);
  ReconstructOptions options = fast();
  options.detector = "geometry";
  try {
    reconstruct(part.bent_scene, options, nullptr);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("colmap image_undistorter"));
  }
}

}  // namespace
}  // namespace sketchsplat
