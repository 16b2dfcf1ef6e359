// SPDX-License-Identifier: MIT
// A published scene in other formats. How well it is reconstructed: tests/floors.csv.
#include <gtest/gtest.h>

#include "pipelines/method/reconstruct.h"
#include "sketches/curve/curve.h"
#include "tests/pipelines/rendered_part.h"
#include "tests/support/colmap_files.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT

// Largest distance between the strokes of two sketches, one by one; infinite if they differ.
double largest_difference(const Sketch& a, const Sketch& b) {
  double largest = 0;
  if (a.size() != b.size()) return HUGE_VAL;
  for (int s = 0; s < a.size(); ++s) {
    if (a.strokes[s].kind != b.strokes[s].kind) return HUGE_VAL;
    for (int k = 0; k <= 20; ++k) {
      Eigen::Vector3d p, q, tangent;
      evaluate_stroke(a, s, k / 20.0, &p, &tangent);
      evaluate_stroke(b, s, k / 20.0, &q, &tangent);
      largest = std::max(largest, (p - q).norm());
    }
  }
  return largest;
}

TEST(ColmapOfAbcNef, GivesTheSameSketchAsTextAndAsBinary) {
  const std::string folder =
      std::string(SKETCHSPLAT_SOURCE_DIR) + "/../shared/data/abc-nef/00000952";
  if (!std::filesystem::exists(folder))
    GTEST_SKIP() << "the scene 00000952 is not beside the sources in shared/data";
  ReconstructOptions options;
  apply_preset("fast", &options);
  const Scene scene = open_scene(folder);
  const Sketch sketch = reconstruct(scene, options, nullptr).sketch;
  for (const bool binary : {false, true}) {
    const TempFolder converted;
    (binary ? write_colmap_binary : write_colmap_text)(colmap_of(scene),
                                                       converted.path() + "/sparse/0");
    std::filesystem::create_directory_symlink(
        std::filesystem::canonical(std::filesystem::path(scene.views[0].image_path).parent_path()),
        converted.path() + "/images");
    const Scene again = open_scene(converted.path());
    EXPECT_EQ(again.format, "colmap");
    ASSERT_EQ(again.views.size(), scene.views.size());
    EXPECT_LT(largest_difference(reconstruct(again, options, nullptr).sketch, sketch), 1e-9);
  }
}

}  // namespace
}  // namespace sketchsplat
