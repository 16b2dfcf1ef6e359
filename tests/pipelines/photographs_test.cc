// SPDX-License-Identifier: MIT
// The whole method on pictures that another renderer drew (tests/photographs/draw.py): soft
// shadows, light between faces, JPEG, a wooden table around the masks.
#include <gtest/gtest.h>

#include "tests/pipelines/rendered_part.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT

TEST(Photographs, SixPicturesOfAnotherRendererGiveTheEdgesOfTheBlock) {
  const std::string folder = std::string(SKETCHSPLAT_SOURCE_DIR) + "/tests/photographs";
  const Sketch sketch = reconstruct_as_ever(open_scene(folder)).sketch;
  EXPECT_TRUE(validate(sketch).empty());
  const Evaluation e = score(sketch, folder);
  EXPECT_GE(f_at(e.fine, 0.005), 99);
  EXPECT_GE(f_at(e.fine, 0.001), 96);
  EXPECT_LE(sketch.size(), e.structure.edges + 1);
  EXPECT_GE(num_of_kind(sketch, StrokeKind::kCircle), 1) << "the boss";
}

}  // namespace
}  // namespace sketchsplat
