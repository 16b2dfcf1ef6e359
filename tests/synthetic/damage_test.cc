// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <omp.h>

#include <filesystem>

#include "datasets/readers/scene.h"
#include "datasets/synthetic/scene/synthesize.h"
#include "datasets/types/errors.h"
#include "tests/datasets/temp_folder.h"

namespace sketchsplat {
namespace {

using testing::HasSubstr;

SynthesizeOptions small() {
  SynthesizeOptions options;
  options.part = "box-hole";
  options.rig.views = 10;
  options.rig.resolution = 64;
  options.outputs = "none";
  return options;
}

Scene reopened(const SyntheticScene& scene, const TempFolder& folder) {
  write_scene(scene, folder.path());
  return open_scene(folder.path());
}

double mean_shift(const SyntheticScene& scene, const std::vector<View>& stated) {
  double sum = 0;
  int count = 0;
  for (size_t k = 0; k < stated.size(); ++k)
    for (const TruthCurve& curve : scene.truth.curves)
      for (int i = 0; i < curve.points.cols(); i += 5) {
        double depth;
        sum += (scene.views[k].project(curve.points.col(i), &depth) -
                stated[k].project(curve.points.col(i), &depth))
                   .norm();
        ++count;
      }
  return sum / count;
}

TEST(PoseNoise, MovesTheProjectedTruthByWhatItSaysAndNoPixel) {
  SynthesizeOptions options = small();
  options.extent = 37;
  const SyntheticScene clean = synthesize(options);
  for (double px : {0.5, 3.0}) {
    const TempFolder folder;
    options.degrade.pose_noise_px = px;
    const SyntheticScene scene = synthesize(options);
    const Scene read = reopened(scene, folder);
    ASSERT_EQ(read.views.size(), 10u);
    EXPECT_TRUE(read.warnings.empty());
    EXPECT_NEAR(mean_shift(scene, read.views), px, 0.1 * px);
    EXPECT_EQ(render(scene, 3).red.data, render(clean, 3).red.data);
    for (size_t k = 0; k < read.views.size(); ++k)
      EXPECT_GT((read.views[k].center_in_world() - scene.views[k].center_in_world()).norm(),
                1e-5 * options.extent);
  }
}

TEST(PoseNoise, MoreOfItIsTheSameErrorScaled) {
  const SyntheticScene scene = synthesize(small());
  const auto error_at = [&](double px) {
    DegradeOptions options;
    options.pose_noise_px = px;
    std::vector<Eigen::Vector3d> errors;
    const std::vector<View> stated = stated_views(scene.unit_views, scene.hints, options, 7);
    for (size_t k = 0; k < stated.size(); ++k)
      errors.push_back(stated[k].cam_from_world.translation -
                       scene.unit_views[k].cam_from_world.translation);
    return errors;
  };
  const auto one = error_at(0.1), two = error_at(0.2);
  for (size_t k = 0; k < one.size(); ++k)
    EXPECT_LT((two[k] - 2 * one[k]).norm(), 0.02 * two[k].norm());
}

TEST(FocalError, IsInTheFileAlone) {
  const TempFolder folder;
  SynthesizeOptions options = small();
  options.degrade.focal_error_percent = -2;
  const SyntheticScene scene = synthesize(options);
  const Scene read = reopened(scene, folder);
  EXPECT_NEAR(read.views[4].camera.fx, 0.98 * scene.views[4].camera.fx, 1e-9);
  EXPECT_LT((read.views[4].center_in_world() - scene.views[4].center_in_world()).norm(), 1e-9);
}

TEST(Missing, FramesAreLeftOutByTheReaderWithTheirNames) {
  const TempFolder folder;
  SynthesizeOptions options = small();
  write_scene(synthesize(options), folder.path());  // a picture that was there does not stay
  options.degrade.missing = 0.3;
  const Scene read = reopened(synthesize(options), folder);
  EXPECT_EQ(read.views.size(), 7u);
  ASSERT_EQ(read.warnings.size(), 3u);
  for (const std::string& warning : read.warnings) {
    EXPECT_THAT(warning, HasSubstr("_colors.png"));
    EXPECT_THAT(warning, HasSubstr("missing"));
  }
}

TEST(Missing, LargerSharesIncludeSmallerOnes) {
  const auto at = [](double missing, double truncated) {
    DegradeOptions options;
    options.missing = missing;
    options.truncated = truncated;
    return fates(40, options, 5);
  };
  const auto few = at(0.1, 0.1), many = at(0.2, 0.5);
  EXPECT_EQ(std::count(few.begin(), few.end(), Fate::kMissing), 4);
  EXPECT_EQ(std::count(few.begin(), few.end(), Fate::kTruncated), 4);
  EXPECT_EQ(std::count(many.begin(), many.end(), Fate::kMissing), 8);
  EXPECT_EQ(std::count(many.begin(), many.end(), Fate::kTruncated), 20);
  for (int k = 0; k < 40; ++k) EXPECT_TRUE(few[k] == Fate::kWhole || few[k] == many[k]) << k;
}

TEST(Truncated, FilesAreThereButCannotBeRead) {
  const TempFolder folder;
  SynthesizeOptions options = small();
  options.degrade.truncated = 0.2;
  const Scene read = reopened(synthesize(options), folder);
  ASSERT_EQ(read.views.size(), 10u);
  int broken = 0;
  for (const View& view : read.views) try {
      read_picture(view);
    } catch (const InputError&) {
      ++broken;
    }
  EXPECT_EQ(broken, 2);
}

TEST(JpegOfScenes, KeepsTheLayoutAndAlphaAndChangesColours) {
  const TempFolder clean, folder;
  SynthesizeOptions options = small();
  const Scene before = reopened(synthesize(options), clean);
  options.render.jpeg = 20;
  const Scene after = reopened(synthesize(options), folder);
  ASSERT_EQ(after.views.size(), before.views.size());
  EXPECT_EQ(after.views[2].name, before.views[2].name);
  const Picture a = read_picture(before.views[2]), b = read_picture(after.views[2]);
  EXPECT_EQ(a.alpha.data, b.alpha.data);
  EXPECT_NE(a.red.data, b.red.data);
  double sum = 0;
  for (size_t i = 0; i < a.red.data.size(); ++i)
    if (a.alpha.data[i] == 1) sum = std::max<double>(sum, std::abs(a.red.data[i] - b.red.data[i]));
  EXPECT_LT(sum, 0.4);
}

TEST(Noise, MoreOfItIsTheSameNoiseScaled) {
  SynthesizeOptions options = small();
  const Picture clean = render(synthesize(options), 0);
  options.render.noise = 1;
  const Picture one = render(synthesize(options), 0);
  options.render.noise = 4;
  const Picture four = render(synthesize(options), 0);
  for (size_t i = 0; i < clean.red.data.size(); ++i) {
    if (four.red.data[i] == 0 || four.red.data[i] == 1) continue;  // clipped
    EXPECT_NEAR(four.red.data[i] - clean.red.data[i], 4 * (one.red.data[i] - clean.red.data[i]),
                1e-5);
  }
}

TEST(Damage, SameSeedSameBytesForAnyNumberOfThreads) {
  SynthesizeOptions options = small();
  options.rig.views = 4;
  options.outputs = "all";
  options.render.noise = 2;
  options.render.jpeg = 60;
  options.degrade = {1.0, 0.5, 0.25, 0.25};
  for (Style style : {Style::kTextured, Style::kGlossy, Style::kShadowed}) {
    options.render.style = style;
    options.render.clutter = style == Style::kGlossy;
    const TempFolder one, two;
    omp_set_num_threads(1);
    write_scene(synthesize(options), one.path());
    omp_set_num_threads(2);
    write_scene(synthesize(options), two.path());
    int files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(one.path())) {
      if (!entry.is_regular_file()) continue;
      const auto name = std::filesystem::relative(entry.path(), one.path());
      EXPECT_TRUE(bytes_of(entry.path().string()) == bytes_of(two.path() / name)) << name;
      ++files;
    }
    EXPECT_EQ(files, 3 + 4 + 4 * 5);  // pictures, truth and meta data, outputs
  }
}

}  // namespace
}  // namespace sketchsplat
