// SPDX-License-Identifier: MIT
// The whole method on rendered parts whose edges are known.
#include "pipelines/method/reconstruct.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <omp.h>

#include "datasets/types/errors.h"
#include "sketches/curve/curve.h"
#include "tests/pipelines/rendered_part.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT

// A box with a hole through it: 12 lines and 2 circles.
class BoxHole : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    write_part("box-hole", 24, 400, 2, folder_->path());
    scene_ = new Scene(open_scene(folder_->path()));
    result_ = new Reconstruction(reconstruct_as_ever(*scene_));
  }
  static void TearDownTestSuite() {
    delete result_;
    delete scene_;
    delete folder_;
  }
  static const TempFolder* folder_;
  static const Scene* scene_;
  static const Reconstruction* result_;
};
const TempFolder* BoxHole::folder_;
const Scene* BoxHole::scene_;
const Reconstruction* BoxHole::result_;

TEST_F(BoxHole, ItsEdgesAreFoundOneStrokeEach) {
  const Sketch& sketch = result_->sketch;
  EXPECT_TRUE(validate(sketch).empty());
  const Evaluation e = score(sketch, folder_->path());
  EXPECT_GE(f_at(e.fine, 0.005), 95);
  EXPECT_GE(f_at(e.fine, 0.002), 80);
  ASSERT_EQ(e.structure.edges, 14);
  EXPECT_LE(sketch.size(), 1.2 * e.structure.edges);
  EXPECT_GE(e.structure.f, 85);
  EXPECT_GE(num_junctions(sketch), 8);
}

TEST_F(BoxHole, EachRimOfTheHoleIsOneCircle) {
  EXPECT_EQ(num_of_kind(result_->sketch, StrokeKind::kCircle), 2);
  EXPECT_EQ(num_of_kind(result_->sketch, StrokeKind::kArc), 0);
}

TEST_F(BoxHole, EvidenceSaysWhoSeesAStroke) {
  for (const Evidence& e : result_->sketch.evidence) {
    EXPECT_GE(e.support_views, 4);
    EXPECT_LE(e.support_views, 24);
    EXPECT_GT(e.opacity, 0.5);
    EXPECT_LE(e.opacity, 1);
    EXPECT_GT(e.rms_px, 0);
    EXPECT_LT(e.rms_px, 0.7);
    EXPECT_GT(e.sigma, 0);
    EXPECT_LT(e.sigma, 1e-3);
  }
}

TEST_F(BoxHole, TheReportTellsWhatHappened) {
  std::vector<std::string> stages;
  for (const StageReport& s : result_->report.stages) stages.push_back(s.name);
  ASSERT_GE(stages.size(), 5u);
  EXPECT_EQ(stages.front(), "detect");
  EXPECT_EQ(stages.back(), "complete");
  const auto count = [&](const std::string& name) {
    for (const auto& [key, value] : result_->report.counts)
      if (key == name) return value;
    return -1.0;
  };
  EXPECT_EQ(count("views"), 24);
  EXPECT_GT(count("edgels"), 5000);
  EXPECT_GT(count("points"), 100);
  EXPECT_EQ(count("strokes"), result_->sketch.size());
  EXPECT_TRUE(result_->report.warnings.empty());
  for (const Numbers& round : result_->report.rounds) EXPECT_EQ(round.back().first, "strokes");
}

TEST_F(BoxHole, RoundsThatDrawLowerTheirLoss) {
  ReconstructOptions options;
  options.optimize.steps = 8;
  options.solid = "off";
  const Reconstruction drawn = reconstruct(*scene_, options, nullptr);
  ASSERT_FALSE(drawn.report.rounds.empty());
  for (const Numbers& round : drawn.report.rounds) {
    double before = -1, after = -1;
    for (const auto& [key, value] : round) {
      if (key == "loss_before") before = value;
      if (key == "loss_after") after = value;
    }
    EXPECT_GT(before, 0);
    EXPECT_GT(after, 0);
    EXPECT_LT(after, 1.02 * before);
  }
}

TEST_F(BoxHole, SameBytesAgainAndForAnyNumberOfThreads) {
  const int before = omp_get_max_threads();
  const std::string expected = json_of(result_->sketch);
  for (int threads : {1, 2}) {
    omp_set_num_threads(threads);
    EXPECT_TRUE(json_of(reconstruct_as_ever(*scene_).sketch) == expected) << threads;
  }
  omp_set_num_threads(before);
}

TEST_F(BoxHole, ResultScalesWithTheUnitOfTheScene) {
  for (double unit : {1e-3, 1e3}) {
    Scene scene = *scene_;
    for (View& v : scene.views) v.cam_from_world.translation *= unit;
    Sketch sketch = reconstruct_as_ever(scene).sketch;
    ASSERT_EQ(sketch.size(), result_->sketch.size()) << unit;
    sketch.nodes /= unit;
    sketch.handles /= unit;
    for (int i = 0; i < sketch.size(); ++i)
      EXPECT_EQ(sketch.strokes[i].kind, result_->sketch.strokes[i].kind);
    const Evaluation e = score(sketch, folder_->path());
    EXPECT_NEAR(f_at(e.fine, 0.005), f_at(score(result_->sketch, folder_->path()).fine, 0.005),
                0.5);
  }
}

TEST_F(BoxHole, EdgeMapsOfOtherDetectorsDo) {
  Scene scene = *scene_;
  const TempFolder folder;
  scene.folder = folder.path();
  for (const View& v : scene.views)
    write_png(folder.file("edge_OURS/" + v.name),
              draw_edge_map(detect_edges(read_picture(v), {}), 1.0));
  ReconstructOptions options;
  options.detector = "maps:ours";
  const Evaluation e = score(reconstruct(scene, options, nullptr).sketch, folder_->path());
  EXPECT_GE(f_at(e.fine, 0.005), 90);
  options.detector = "maps:nobody";
  EXPECT_THROW(reconstruct(scene, options, nullptr), InputError);
}

TEST_F(BoxHole, LargePicturesAreMadeSmallerAndTheirCamerasComeBackAtFullSize) {
  ReconstructOptions options;
  options.least_side = 200;  // half of what they have
  options.refine_poses = "on";
  const Reconstruction r = reconstruct(*scene_, options, nullptr);
  EXPECT_GE(f_at(score(r.sketch, folder_->path()).fine, 0.005), 93);
  ASSERT_EQ(r.refined.size(), scene_->views.size());
  for (size_t v = 0; v < r.refined.size(); ++v) {
    const View &now = r.refined[v], &stated = scene_->views[v];
    EXPECT_EQ(now.image_path, stated.image_path);
    EXPECT_EQ(now.camera.width, 400);
    EXPECT_NEAR(now.camera.fx, stated.camera.fx, 0.01 * stated.camera.fx);
    EXPECT_NEAR(now.camera.cx, stated.camera.cx, 2);
  }
  EXPECT_EQ(read_picture(r.refined[0]).width(), 400);
}

TEST_F(BoxHole, GoesOnWithoutAFrameThatIsTruncatedAndOneThatIsMissing) {
  const TempFolder folder;
  std::filesystem::copy(folder_->path(), folder.path(), std::filesystem::copy_options::recursive);
  const std::string broken = folder.path() + "/color/5_colors.png";
  ASSERT_TRUE(std::filesystem::exists(broken));
  std::filesystem::resize_file(broken, std::filesystem::file_size(broken) / 3);
  std::filesystem::remove(folder.path() + "/color/11_colors.png");
  const Reconstruction r = reconstruct_as_ever(open_scene(folder.path()));
  EXPECT_THAT(r.report.warnings,
              testing::UnorderedElementsAre(testing::HasSubstr("5_colors.png"),
                                            testing::HasSubstr("11_colors.png")));
  EXPECT_GE(f_at(score(r.sketch, folder_->path()).fine, 0.005), 93);
}

TEST_F(BoxHole, FewViewsGiveASketchOrAClearRefusal) {
  for (size_t count : {1, 2, 3, 4, 6}) {
    Scene scene = *scene_;
    scene.views.resize(count);
    try {
      const Sketch sketch = reconstruct_as_ever(scene).sketch;
      EXPECT_GE(count, 3u);
      EXPECT_TRUE(validate(sketch).empty());
    } catch (const TooLittleError& e) {
      EXPECT_LE(count, 4u);
      EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
    }
  }
}

// A scene of pictures that hold one grey each.
Scene blank_scene(const Scene& like, const TempFolder& folder) {
  Scene scene = like;
  scene.folder = folder.path();
  for (View& v : scene.views) {
    v.image_path = folder.file(v.name);
    write_png(v.image_path, Image<float>(400, 400, 0.5f));
  }
  return scene;
}

TEST_F(BoxHole, PicturesWithoutAnyEdgeAreTooLittle) {
  const TempFolder folder;
  Scene scene = blank_scene(*scene_, folder);
  EXPECT_THROW(reconstruct_as_ever(scene), TooLittleError);
  for (View& v : scene.views) std::filesystem::remove(v.image_path);
  EXPECT_THROW(reconstruct_as_ever(scene), InputError) << "and none at all is an error";
}

TEST_F(BoxHole, NoCurveThatEnoughViewsSeeIsTooLittle) {
  ReconstructOptions options;
  options.select.min_views = 1000;  // there are 24
  EXPECT_THROW(reconstruct(*scene_, options, nullptr), TooLittleError);
}

TEST_F(BoxHole, PicturesUnderWrongPosesGiveLessThanThePartOrARefusal) {
  Scene scene = *scene_;  // every picture under the pose of another: what meets, meets by chance
  const size_t n = scene.views.size();
  for (size_t i = 0; i < n; ++i)
    scene.views[i].image_path = scene_->views[(i * 7 + 3) % n].image_path;
  try {
    const Sketch sketch = reconstruct_as_ever(scene).sketch;
    EXPECT_TRUE(validate(sketch).empty());
    EXPECT_LT(f_at(score(sketch, folder_->path()).fine, 0.005), 30);
  } catch (const TooLittleError&) {
  }
}

}  // namespace
}  // namespace sketchsplat
