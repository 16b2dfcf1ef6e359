// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <filesystem>

#include "datasets/io/image_io.h"
#include "datasets/types/errors.h"
#include "datasets/types/geometry_maps.h"
#include "tests/pipelines/rendered_part.h"

namespace sketchsplat {
namespace {

using test::f_at;
using test::score;

// A plate with a round hole, with its depth and normals.
struct Rendered {
  TempFolder folder;
  Scene scene;
  Rendered() {
    SynthesizeOptions options;
    options.part = "box-hole";
    options.seed = 2;
    options.rig.views = 16;
    options.rig.resolution = 240;
    options.outputs = "all";
    write_scene(synthesize(options), folder.path());
    scene = open_scene(folder.path());
  }
};

TEST(GeometryDetector, ReconstructsFromDepthAndNormalsAlone) {
  const Rendered part;
  ReconstructOptions options;
  options.detector = "geometry";
  for (const View& v : part.scene.views) std::filesystem::remove(v.image_path);
  const Reconstruction result = reconstruct(part.scene, options, nullptr);
  EXPECT_GE(f_at(score(result.sketch, part.folder.path()).fine, 0.005), 95);
}

TEST(GeometryDetector, TakesNormalMapsOfEstimatorsInstead) {
  const Rendered part;
  const std::string folder = part.folder.path() + "/estimated";
  std::filesystem::create_directories(folder);
  const View& view = part.scene.views[0];
  const GeometryMaps own = read_geometry_maps(part.scene, view);
  // As they are painted: x right, y up, z to the viewer.
  Picture painted;
  painted.red = painted.green = painted.blue = Image<float>(own.width(), own.height());
  for (size_t i = 0; i < own.depth.data.size(); ++i) {
    if (!(own.depth.data[i] > 0)) continue;
    painted.red.data[i] = 0.5f + 0.5f * own.normal[0].data[i];
    painted.green.data[i] = 0.5f - 0.5f * own.normal[1].data[i];
    painted.blue.data[i] = 0.5f - 0.5f * own.normal[2].data[i];
  }
  write_png(folder + "/" + view.name, painted);
  const GeometryMaps theirs = read_geometry_maps(part.scene, view, folder);
  for (size_t i = 0; i < own.depth.data.size(); ++i)
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(theirs.normal[c].data[i], own.normal[c].data[i], 0.02);
}

TEST(GeometryDetector, SaysWhatIsMissing) {
  const Rendered part;
  ReconstructOptions options;
  options.detector = "geometry";
  std::filesystem::remove_all(part.folder.path() + "/depth");
  EXPECT_THROW(reconstruct(part.scene, options, nullptr), InputError);
}

}  // namespace
}  // namespace sketchsplat
