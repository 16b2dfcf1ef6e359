// SPDX-License-Identifier: MIT
// The part of a synthetic scene as a STEP file, and solids compared with it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/pipelines/program.h"

namespace sketchsplat {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

class Solids : public Program {
 protected:
  // A scene of a built-in part, and a result that is its truth but for the solid.
  void make(const std::string& part, const std::string& name, const std::string& extent = "1") {
    const std::string scene = in_folder("scenes/" + name), result = in_folder("results/" + name);
    fs::create_directories(result);
    ASSERT_EQ(run("synthesize " + part + " --views 2 --resolution 16 --extent " + extent +
                  " --quiet --out '" + scene + "'")
                  .status,
              0);
    fs::copy_file(scene + "/groundtruth/sketch.json", result + "/sketch.json");
  }
  std::string part_of(const std::string& name) const {
    return in_folder("scenes/" + name + "/groundtruth/part.step");
  }
  std::string pair(const std::string& name) const {
    return " --pred '" + in_folder("results" + name) + "' --gt '" + in_folder("scenes" + name) +
           "'";
  }
  json compared(const std::string& arguments) const {
    const Outcome o = run("evaluate" + arguments + " --json");
    EXPECT_EQ(o.status, 0) << o.err;
    return json::parse(o.out);
  }
};

TEST_F(Solids, ThePartOfASceneIsItself) {
  make("box-hole", "a", "40");
  EXPECT_FALSE(compared(pair("/a")).contains("solid")) << "the result has none";
  fs::copy_file(part_of("a"), in_folder("results/a/solid.step"));
  const json solid = compared(pair("/a"))["solid"];
  EXPECT_EQ(solid["valid"], true);
  EXPECT_NEAR(double(solid["iou"]), 1, 1e-6);
  EXPECT_EQ(solid["face_f"], 1);
  EXPECT_EQ(solid["faces"], 7);
  EXPECT_LT(double(solid["largest_distance"]), 0.004);
  EXPECT_LT(double(solid["volume"]), 40.0 * 40 * 40) << "world units are millimetres";
  EXPECT_GT(double(solid["volume"]), 40 * 10 * 10);
  EXPECT_THAT(run("evaluate" + pair("/a")).out, HasSubstr("solid: IoU 1.000000, 7 faces of 7: P"));
}

TEST_F(Solids, AnotherPartIsNot) {
  make("box-hole", "a");
  make("box", "b");
  const json solid = compared(pair("/a") + " --solid '" + part_of("b") + "'")["solid"];
  EXPECT_LT(double(solid["iou"]), 0.99);
  EXPECT_EQ(solid["faces"], 6);
  EXPECT_EQ(solid["true_faces"], 7);
}

TEST_F(Solids, ManyScenesHaveAColumnEach) {
  make("box-hole", "a");
  make("box", "b");
  fs::copy_file(part_of("a"), in_folder("results/a/solid.step"));
  const Outcome o = run("evaluate" + pair("") + " --out '" + in_folder("numbers") + "'");
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(text_of_file(in_folder("numbers/evaluation.csv")), HasSubstr("solid.iou"));
  const json all = json::parse(text_of_file(in_folder("numbers/evaluation.json")));
  EXPECT_NEAR(double(all["mean"]["solid.iou"]), 1, 1e-6) << "of those that have one";
}

TEST_F(Solids, FilesThatAreNotThereAreBadInput) {
  make("box", "a");
  const Outcome none = run("evaluate" + pair("/a") + " --solid nowhere.step");
  EXPECT_EQ(none.status, kBadInput);
  EXPECT_THAT(none.err, HasSubstr("nowhere.step"));
  EXPECT_EQ(run("evaluate" + pair("") + " --solid '" + part_of("a") + "'").status, kWrongUsage);
  std::ofstream(in_folder("results/a/solid.step")) << "no STEP file";
  const Outcome broken = run("evaluate" + pair("/a"));
  EXPECT_EQ(broken.status, 0) << "edges are compared all the same";
  EXPECT_THAT(broken.err, HasSubstr("solid.step"));
  EXPECT_THAT(broken.out, Not(HasSubstr("solid")));
}

TEST_F(Solids, AMeshHasNoPart) {
  std::ofstream mesh(in_folder("block.obj"));
  for (int k = 0; k < 8; ++k)
    mesh << "v " << (k & 1) << " " << (k >> 1 & 1) << " " << (k >> 2) << "\n";
  mesh << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  mesh.close();
  make("'" + in_folder("block.obj") + "'", "a");
  EXPECT_FALSE(fs::exists(part_of("a")));
}

}  // namespace
}  // namespace sketchsplat
