// SPDX-License-Identifier: MIT
// What curved surfaces and many small features do to the method.
#include <gtest/gtest.h>

#include <ostream>

#include "pipelines/reconstruct.h"
#include "tests/pipelines/rendered_part.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT

struct Expected {
  const char* part;
  double f5, precision5;    ///< per cent, at least
  double strokes_per_edge;  ///< at most
};
void PrintTo(const Expected& e, std::ostream* out) { *out << e.part; }

class Part : public testing::TestWithParam<Expected> {};

TEST_P(Part, ItsEdgesAreFoundAndNoContourIsTakenForOne) {
  const Expected expected = GetParam();
  const TempFolder folder;
  write_part(expected.part, 30, 400, 1, folder.path());
  const Sketch sketch = reconstruct(open_scene(folder.path()), {}, nullptr).sketch;
  EXPECT_TRUE(validate(sketch).empty());
  const Evaluation e = score(sketch, folder.path());
  EXPECT_GE(f_at(e.fine, 0.005), expected.f5);
  for (const Level& level : e.fine.levels)
    if (level.threshold == 0.005) EXPECT_GE(level.precision, expected.precision5);
  EXPECT_LE(sketch.size(), expected.strokes_per_edge * e.structure.edges);
  RecordProperty("f5", std::to_string(f_at(e.fine, 0.005)));
  std::cout << expected.part << " F5 " << f_at(e.fine, 0.005) << " P5 "
            << e.fine.levels[0].precision << " strokes " << sketch.size() << "/"
            << e.structure.edges << " thr " << e.fine.levels[0].threshold << "\n";
}

INSTANTIATE_TEST_SUITE_P(
    Synthetic, Part,
    testing::Values(Expected{"box", 97, 97, 1.1}, Expected{"cut-cylinder", 80, 80, 1.5},
                    Expected{"frustum", 80, 80, 1.5}, Expected{"hex-nut", 80, 80, 1.5},
                    Expected{"l-bracket", 80, 80, 1.5}, Expected{"box-fillet", 80, 80, 1.5},
                    Expected{"dome-plate", 80, 80, 1.5}, Expected{"flange", 80, 80, 1.5}),
    [](const auto& info) {
      std::string name = info.param.part;
      for (char& c : name)
        if (c == '-') c = '_';
      return name;
    });

}  // namespace
}  // namespace sketchsplat
