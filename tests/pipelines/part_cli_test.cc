// SPDX-License-Identifier: MIT
// What users are told about the built-in parts and their dimensions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/pipelines/program.h"

namespace sketchsplat {
namespace {

using testing::HasSubstr;

TEST_F(Program, ListsItsPartsWithoutASceneToWrite) {
  const Outcome o = run("synthesize --list-parts");
  EXPECT_EQ(o.status, 0);
  EXPECT_EQ(o.err, "");
  EXPECT_THAT(o.out, HasSubstr("rib-plate\n"));
  EXPECT_THAT(o.out, HasSubstr("gap            0.002 to 0.2 "));
  EXPECT_EQ(run("synthesize").status, kWrongUsage) << "a scene needs a place";
}

TEST_F(Program, RefusesDimensionsThatAPartHasNotAndListsThoseItHas) {
  const std::string out = " --out '" + in_folder("scene") + "'";
  for (const char* arguments : {"rib-plate --param gap=0.5", "rib-plate --param hole=0.1",
                                "rib-plate --param gap=0.1 --param wall=9"}) {
    const Outcome o = run(std::string("synthesize ") + arguments + out);
    EXPECT_EQ(o.status, kWrongUsage) << arguments;
    EXPECT_EQ(count_lines(o.err), 1) << o.err;
    EXPECT_THAT(o.err, HasSubstr("gap (0.002 to 0.2 of longest side), wall (")) << arguments;
  }
  EXPECT_EQ(run("synthesize rib-plate --param gap" + out).status, kWrongUsage);
  EXPECT_EQ(run("synthesize rib-plate --param gap=wide" + out).status, kWrongUsage);
  EXPECT_EQ(run("synthesize some.step --param gap=0.1" + out).status, kWrongUsage);
  EXPECT_FALSE(fs::exists(in_folder("scene")));
}

TEST_F(Program, TakesSeveralDimensionsBeforeThePart) {
  const std::string arguments = " --views 1 --resolution 16 --quiet --out ";
  const auto sketch = [&](const std::string& name) {
    return text_of_file(fs::path(in_folder(name)) / "groundtruth" / "sketch.json");
  };
  EXPECT_EQ(
      run("synthesize --param gap=0.03 --param wall=0.02 rib-plate" + arguments + in_folder("a"))
          .status,
      0);
  EXPECT_EQ(
      run("synthesize rib-plate --param wall=0.02 --param gap=0.03" + arguments + in_folder("b"))
          .status,
      0);
  EXPECT_EQ(run("synthesize rib-plate" + arguments + in_folder("c")).status, 0);
  EXPECT_EQ(sketch("a"), sketch("b"));
  EXPECT_NE(sketch("a"), sketch("c"));
}

}  // namespace
}  // namespace sketchsplat
