// SPDX-License-Identifier: MIT
// The whole method on published scenes, with floors below what it reaches there.
#include <gtest/gtest.h>

#include <ostream>

#include "pipelines/reconstruct.h"
#include "tests/pipelines/rendered_part.h"

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
  const Sketch sketch = reconstruct(open_scene(folder), {}, nullptr).sketch;
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

}  // namespace
}  // namespace sketchsplat
