// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <omp.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "datasets/readers/scene.h"
#include "sketchsplat/evaluate.h"
#include "sketchsplat/reconstruct.h"
#include "sketchsplat/version.h"

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;

// A synthetic bracket in a folder, and the same in memory.
class Library : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = fs::temp_directory_path() / ("sketchsplat_library." + std::to_string(getpid()));
    const std::string command = std::string("'") + SKETCHSPLAT_BINARY +
                                "' synthesize l-bracket --views 14 --resolution 280 --noise 1 "
                                "--outputs none --quiet --out '" +
                                folder_.string() + "' >/dev/null";
    ASSERT_EQ(std::system(command.c_str()), 0);
    for (const View& view : open_scene(folder_).views) {
      const Picture picture = read_picture(view);
      std::vector<std::uint8_t> bytes;
      for (size_t i = 0; i < picture.red.data.size(); ++i)
        for (const Image<float>* c : {&picture.red, &picture.green, &picture.blue, &picture.alpha})
          bytes.push_back(c->empty() ? 255 : std::uint8_t(std::lround(c->data[i] * 255)));
      pixels_.push_back(std::move(bytes));
      InputView v;
      v.name = view.name;
      v.width = view.camera.width, v.height = view.camera.height;
      v.intrinsics << view.camera.fx, 0, view.camera.cx, 0, view.camera.fy, view.camera.cy, 0, 0, 1;
      v.rotation = view.cam_from_world.rotation;
      v.translation = view.cam_from_world.translation;
      v.channels = 4;
      views_.push_back(v);
    }
    for (size_t i = 0; i < views_.size(); ++i) views_[i].pixels = pixels_[i].data();
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }

  static inline fs::path folder_;
  static inline std::vector<std::vector<std::uint8_t>> pixels_;
  static inline std::vector<InputView> views_;
};

TEST_F(Library, ImagesInMemoryGiveWhatTheirFolderGives) {
  Options options;
  options.preset = "fast";
  const CurveSketch a = reconstruct(folder_.string(), options), b = reconstruct(views_, options);
  EXPECT_EQ(a.ending, Ending::kDone);
  ASSERT_GT(a.curves.size(), 10u);
  ASSERT_EQ(a.nodes.cols(), b.nodes.cols());
  EXPECT_LT((a.nodes - b.nodes).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_EQ(a.views, b.views);
  EXPECT_GT(evaluate(b, folder_.string()).levels[2].f, 90);
}

TEST_F(Library, ThreadsChangeNothingAndAreGivenBack) {
  const int before = omp_get_max_threads();
  Options one, three;
  one.preset = three.preset = "fast";
  one.threads = 1, three.threads = 3;
  EXPECT_EQ(reconstruct(views_, one).nodes, reconstruct(views_, three).nodes);
  EXPECT_EQ(omp_get_max_threads(), before);
}

TEST_F(Library, ExpertOptionsCountAndWrongOnesAreRefused) {
  Options options;
  options.preset = "fast";
  options.expert["min-views"] = "1000";
  EXPECT_EQ(reconstruct(views_, options).ending, Ending::kTooLittle);
  options.expert = {{"min-veiws", "1000"}};
  EXPECT_THROW(reconstruct(views_, options), std::invalid_argument);
  options.expert = {{"conics", "false"}};  // is --without conics
  EXPECT_THROW(reconstruct(views_, options), std::invalid_argument);
  options.expert = {{"without", "conix"}};
  EXPECT_THROW(reconstruct(views_, options), std::invalid_argument);
  options.expert = {{"rounds", "-1"}};
  EXPECT_THROW(reconstruct(views_, options), std::invalid_argument);
}

TEST_F(Library, WhoeverWatchesMayCancel) {
  Options options;
  int after = 0;
  bool lifting = false;
  options.progress = [&](const StageProgress& p) {
    after += lifting && p.stage != "lift";
    lifting |= p.stage == "lift";
    return !lifting;
  };
  const CurveSketch sketch = reconstruct(views_, options);
  EXPECT_EQ(sketch.ending, Ending::kCancelled);
  EXPECT_TRUE(sketch.curves.empty());
  EXPECT_EQ(after, 0);
}

TEST_F(Library, AMaskIsWhatAlphaIs) {
  std::vector<std::vector<std::uint8_t>> masks;
  for (const auto& bytes : pixels_) {
    masks.emplace_back();
    for (size_t i = 3; i < bytes.size(); i += 4) masks.back().push_back(bytes[i]);
  }
  std::vector<InputView> masked = views_;
  std::vector<std::vector<std::uint8_t>> opaque = pixels_;
  for (size_t k = 0; k < masked.size(); ++k) {
    for (size_t i = 3; i < opaque[k].size(); i += 4) opaque[k][i] = 255;
    masked[k].pixels = opaque[k].data(), masked[k].mask = masks[k].data();
  }
  Options options;
  options.preset = "fast";
  EXPECT_EQ(reconstruct(masked, options).nodes, reconstruct(views_, options).nodes);
}

TEST_F(Library, CamerasThatAreNoneAreNamed) {
  std::vector<InputView> views = views_;
  views[1].rotation *= 2;
  try {
    reconstruct(views);
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(), testing::StartsWith(views[1].name + ": expected a rotation"));
  }
  views = views_;
  views[2].intrinsics(0, 0) = 0;
  EXPECT_THROW(reconstruct(views), std::invalid_argument);
  views = views_;
  views[2].name = views[1].name;
  EXPECT_THROW(reconstruct(views), std::invalid_argument);
  views = views_;
  views[2].distortion = {0.1, 0.2, 0.3};
  EXPECT_THROW(reconstruct(views), std::invalid_argument);
  EXPECT_THROW(reconstruct(std::vector<InputView>()), std::invalid_argument);
  EXPECT_THROW(reconstruct("/nowhere"), std::runtime_error);
}

TEST_F(Library, AnEmptySketchCanBeSampledByNobodyAndWritten) {
  const CurveSketch none;
  EXPECT_THROW(none.sample(0, 0.1), std::invalid_argument);
  const fs::path file = folder_ / "none.step";
  none.write(file);
  EXPECT_GT(fs::file_size(file), 100u);
  EXPECT_THROW(none.write(folder_ / "none.png"), std::invalid_argument);
  EXPECT_FALSE(fs::exists(folder_ / "none.png"));
}

}  // namespace
}  // namespace sketchsplat
