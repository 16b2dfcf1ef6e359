// SPDX-License-Identifier: MIT
// The whole method on published scenes, with floors below what it reaches there.
#include <gtest/gtest.h>

#include <ostream>

#include "pipelines/method/reconstruct.h"
#include "sketches/curve/curve.h"
#include "tests/pipelines/rendered_part.h"
#include "tests/support/colmap_files.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT

struct Floor {
  const char* scene;
  double f5, f2;            ///< per cent
  double strokes_per_edge;  ///< at most
};
void PrintTo(const Floor& floor, std::ostream* out) { *out << floor.scene; }

class AbcNef : public testing::TestWithParam<Floor> {};

TEST_P(AbcNef, EdgesAreFoundSharplyAndInFewStrokes) {
  const Floor floor = GetParam();
  const std::string folder =
      std::string(SKETCHSPLAT_SOURCE_DIR) + "/../shared/data/abc-nef/" + floor.scene;
  if (!std::filesystem::exists(folder))
    GTEST_SKIP() << "the scene " << floor.scene << " is not beside the sources in shared/data";
  const Sketch sketch = reconstruct_as_ever(open_scene(folder)).sketch;
  EXPECT_TRUE(validate(sketch).empty());
  const Evaluation e = score(sketch, folder);
  EXPECT_GE(f_at(e.fine, 0.005), floor.f5);
  EXPECT_GE(f_at(e.fine, 0.002), floor.f2);
  ASSERT_GT(e.structure.edges, 0);
  EXPECT_LE(double(sketch.size()) / e.structure.edges, floor.strokes_per_edge);
}

INSTANTIATE_TEST_SUITE_P(Scenes, AbcNef,
                         testing::Values(Floor{"00000952", 98, 96, 1.1},
                                         Floor{"00004605", 97, 93, 1.3},
                                         Floor{"00004926", 97, 88, 1.5}),
                         [](const auto& info) { return info.param.scene; });

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
