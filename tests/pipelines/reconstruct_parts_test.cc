// SPDX-License-Identifier: MIT
// What curved surfaces and many small features do to the method.
#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <string>

#include "pipelines/method/reconstruct.h"
#include "tests/pipelines/rendered_part.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT

struct Expected {
  const char* part;
  double f5, precision5;    ///< per cent, at least
  double strokes_per_edge;  ///< at most
  int views = 30, pixels = 400;
};
void PrintTo(const Expected& e, std::ostream* out) { *out << e.part; }

class Part : public testing::TestWithParam<Expected> {};

TEST_P(Part, ItsEdgesAreFoundAndNoContourIsTakenForOne) {
  const Expected expected = GetParam();
  const TempFolder folder;
  write_part(expected.part, expected.views, expected.pixels, 1, folder.path());
  const Sketch sketch = reconstruct_as_ever(open_scene(folder.path())).sketch;
  EXPECT_TRUE(validate(sketch).empty());
  const Evaluation e = score(sketch, folder.path());
  EXPECT_GE(f_at(e.fine, 0.005), expected.f5);
  for (const Level& level : e.fine.levels) {
    if (level.threshold == 0.005) {
      EXPECT_GE(level.precision, expected.precision5);
    }
  }
  EXPECT_LE(sketch.size(), expected.strokes_per_edge * e.structure.edges);
}

INSTANTIATE_TEST_SUITE_P(
    Synthetic, Part,
    testing::Values(Expected{"cut-cylinder", 95, 97, 2}, Expected{"frustum", 95, 97, 1.5},
                    Expected{"l-bracket", 92, 97, 1.3}, Expected{"box-fillet", 85, 92, 1.3},
                    Expected{"dome-plate", 94, 97, 1.3}, Expected{"flange", 93, 98, 1.1},
                    Expected{"cut-cylinder", 97, 97, 1, 16, 300}),
    [](const auto& info) {
      std::string name = info.param.part + ("_" + std::to_string(info.param.pixels));
      std::replace(name.begin(), name.end(), '-', '_');
      return name;
    });

// Its sides are mirror images of one another but for their rounds, so that sharp edges lead to
// expect others where rounds are.
TEST(RoundedPart, WhatSymmetryLeadsToExpectIsNoEdgeWhereARoundIs) {
  const TempFolder folder;
  write_rounded_part("cast-bracket", 0, 0.02, folder.path());  // 4 px
  const Sketch sketch = reconstruct_as_ever(open_scene(folder.path())).sketch;
  const Evaluation e = score(sketch, folder.path());
  for (const Level& level : e.fine.levels) {
    if (level.threshold == 0.005) {
      EXPECT_GE(level.precision, 93);
      EXPECT_GE(level.recall, 98);
    }
  }
}

}  // namespace
}  // namespace sketchsplat
