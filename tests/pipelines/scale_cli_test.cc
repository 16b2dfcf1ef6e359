// SPDX-License-Identifier: MIT
// Millimetres, boxes and deadlines as their users meet them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/pipelines/program.h"

namespace sketchsplat {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const char kScene[] =
    "synthesize box-hole --views 20 --resolution 320 --seed 3 --outputs none --quiet --out ";
const char kPhotos[] =
    "synthesize l-bracket --style photo --views 16 --resolution 480 --tag 5 --tag-size 0.3 --seed "
    "2 "
    "--outputs none --quiet --out ";

class Scale : public Program {
 protected:
  static void SetUpTestSuite() {
    base_ =
        (fs::temp_directory_path() / ("sketchsplat_scale." + std::to_string(getpid()))).string();
    scene_ = base_ + "/scene", photos_ = base_ + "/photos", result_ = base_ + "/result";
    fs::create_directories(base_);
    Program::run_in(base_, kScene + scene_);
    Program::run_in(base_, kPhotos + photos_);
    Program::run_in(base_, "reconstruct " + scene_ + " --preset fast --overlays 1 --out " +
                               result_ + " --scale-by diameter=2cm");
  }
  static void TearDownTestSuite() { fs::remove_all(base_); }

  static json json_in(const fs::path& path) { return json::parse(text_of_file(path)); }
  // First coordinate of the first vertex of an OBJ.
  static double first_number(const std::string& obj) {
    std::istringstream in(obj.substr(obj.find("\nv ") + 3));
    double x = 0;
    in >> x;
    return x;
  }
  static double largest_diameter(const json& sketch) {
    double most = 0;
    for (const json& s : sketch["strokes"])
      if (s["kind"] == "circle") most = std::max(most, 2 * s["radius"].get<double>());
    return most;
  }

  static std::string base_, scene_, photos_, result_;
};
std::string Scale::base_, Scale::scene_, Scale::photos_, Scale::result_;

TEST_F(Scale, AKnownDiameterScalesTheCadFilesAndLeavesTheOthersInWorldUnits) {
  const json sketch = json_in(result_ + "/sketch.json"), report = json_in(result_ + "/report.json");
  const double scale = 20 / largest_diameter(sketch);
  EXPECT_NEAR(report["scale"]["units_per_world"].get<double>(), scale, 1e-9 * scale);
  EXPECT_NEAR(report["scale"]["world_per_unit"].get<double>(), 1 / scale, 1e-9 / scale);
  EXPECT_EQ(report["scale"]["unit"], "mm");
  EXPECT_EQ(report["scale"]["source"], "--scale-by diameter=2cm");
  EXPECT_GT(report["scale"]["sigma_relative"], 1e-6);
  EXPECT_LT(report["scale"]["sigma_relative"], 2e-2);
  EXPECT_EQ(sketch["scale"], report["scale"]);
  // The part is 1 long in the world.
  for (const json& n : sketch["nodes"])
    for (const json& x : n) EXPECT_LT(std::abs(x.get<double>()), 1.1);
  EXPECT_THAT(text_of_file(result_ + "/report.html"), HasSubstr("units_per_world"));
}

TEST_F(Scale, ExportKnowsWhatReconstructFoundOut) {
  const std::string scaled = in_folder("a.obj"), plain = in_folder("b.obj");
  ASSERT_EQ(run("export " + result_ + " -o " + scaled).status, 0);
  EXPECT_EQ(text_of_file(scaled), text_of_file(result_ + "/sketch.obj"));
  const double scale = json_in(result_ + "/report.json")["scale"]["units_per_world"];
  ASSERT_EQ(run("export " + result_ + " -o " + plain + " --scale 1").status, 0);
  EXPECT_NEAR(first_number(text_of_file(scaled)), scale * first_number(text_of_file(plain)), 1e-4);
  const std::string inches = in_folder("c.obj");
  ASSERT_EQ(run("export " + result_ + " -o " + inches + " --unit inch").status, 0);
  EXPECT_NEAR(first_number(text_of_file(inches)), first_number(text_of_file(scaled)) / 25.4, 1e-5);
  const std::string step = in_folder("d.step");
  ASSERT_EQ(run("export " + result_ + " -o " + step).status, 0);
  EXPECT_THAT(text_of_file(step), HasSubstr(",10."));  // the radius
}

TEST_F(Scale, ExportScalesByACurveOfTheReport) {
  const json sketch = json_in(result_ + "/sketch.json");
  int line = 0;
  while (sketch["strokes"][line]["kind"] != "line") ++line;
  const auto& ends = sketch["strokes"][line]["nodes"];
  double length = 0;
  for (int k = 0; k < 3; ++k)
    length += std::pow(sketch["nodes"][ends[0].get<int>()][k].get<double>() -
                           sketch["nodes"][ends[1].get<int>()][k].get<double>(),
                       2);
  const std::string out = in_folder("scaled.json");
  ASSERT_EQ(run("export " + result_ + " --format sketch -o " + out +
                " --scale-by line:" + std::to_string(line) + "=80mm --unit cm")
                .status,
            0);
  const json scaled = json_in(out);
  EXPECT_NEAR(scaled["scale"]["units_per_world"].get<double>(), 8 / std::sqrt(length), 1e-9);
  EXPECT_EQ(scaled["scale"]["unit"], "cm");
  EXPECT_EQ(scaled["nodes"], sketch["nodes"]) << "world units";
  const Outcome wrong = run("export " + result_ + " -o " + in_folder("x.step") +
                            " --scale-by circle:" + std::to_string(line) + "=80");
  EXPECT_EQ(wrong.status, 3);
  EXPECT_THAT(wrong.err, HasSubstr("found line"));
  EXPECT_EQ(run("export " + result_ + " -o x.step --scale-by tag=10").status, 2);
  EXPECT_EQ(run("export " + result_ + " -o x.step --scale-by line:1=8 --scale 3").status, 2);
  EXPECT_EQ(run("export " + result_ + " -o x.ply --scale-by line:1=8").status, 2);
}

TEST_F(Scale, ATagInPhotographsTellsIt) {
  const json truth = json_in(photos_ + "/scene.json")["tag"]["corners"];
  double side = 0;
  for (int k = 0; k < 3; ++k)
    side += std::pow(truth[0][k].get<double>() - truth[1][k].get<double>(), 2);
  side = std::sqrt(side);
  const Outcome plan =
      run("reconstruct " + photos_ + " -o none --scale-by tag=10mm --dry-run --json");
  ASSERT_EQ(plan.status, 0) << plan.err;
  const json scale = json::parse(plan.out)["scale"];
  EXPECT_NEAR(scale["units_per_world"].get<double>() * side / 10, 1, 1e-3);
  EXPECT_LT(scale["sigma_relative"], 1e-3);
  EXPECT_EQ(scale["tags"][0]["id"], 5);
  EXPECT_GE(scale["tags"][0]["views"], 6);

  const Outcome o = run("reconstruct " + photos_ + " --preset fast --overlays 0 -o " +
                        in_folder("tag") + " --scale-by tag:5=10 --budget 20");
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("a world unit is"));
  EXPECT_EQ(json_in(in_folder("tag/report.json"))["scale"]["units_per_world"],
            scale["units_per_world"]);
  EXPECT_EQ(run("reconstruct " + scene_ + " -o " + in_folder("no") + " --scale-by tag=10").status,
            4)
      << "there is none";
}

TEST_F(Scale, WhatCannotBeHadIsAWarning) {
  const Outcome o = run("reconstruct " + scene_ + " --preset fast --overlays 0 -o " +
                        in_folder("warned") + " --scale-by line:9999=1 --budget 0.001");
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.err, HasSubstr("lengths stay in world units"));
  EXPECT_FALSE(json_in(in_folder("warned/report.json")).contains("scale"));
}

// However early the time is up, there is a sound result.
TEST_F(Scale, ATinyBudgetStopsRefiningAndNotReporting) {
  const Outcome o =
      run("reconstruct " + scene_ + " --overlays 1 --budget 0.001 -o " + in_folder("early"));
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.err, HasSubstr("budget of 0.001 s is used up"));
  const json report = json_in(in_folder("early/report.json"));
  EXPECT_TRUE(report["rounds"].empty());
  EXPECT_GT(report["counts"]["curves"], 5);
  EXPECT_EQ(run("export " + in_folder("early") + " -o " + in_folder("e.step")).status, 0)
      << "sound enough to be read";
  const Outcome enough =
      run("reconstruct " + scene_ + " --preset fast --overlays 0 --budget 1000 " +
          "--reproducible -o " + in_folder("enough"));
  EXPECT_EQ(enough.err.find("budget"), std::string::npos);
  ASSERT_EQ(run("reconstruct " + scene_ + " --preset fast --overlays 0 --reproducible -o " +
                in_folder("all"))
                .status,
            0);
  EXPECT_EQ(json_in(in_folder("enough/sketch.json"))["strokes"],
            json_in(in_folder("all/sketch.json"))["strokes"]);
}

TEST_F(Scale, ABoxCutsOutTheObject) {
  ASSERT_EQ(run("reconstruct " + scene_ + " --preset fast --overlays 0 -o " + in_folder("half") +
                " --box=-1,-1,-1,2,2,0.5")
                .status,
            0);
  const json all = json_in(result_ + "/sketch.json"), half = json_in(in_folder("half/sketch.json"));
  double top_of_all = 0, top = 0;
  for (const json& n : all["nodes"]) top_of_all = std::max(top_of_all, n[2].get<double>());
  for (const json& n : half["nodes"]) top = std::max(top, n[2].get<double>());
  EXPECT_GT(top_of_all, 0.6);
  EXPECT_LT(top, 0.56);
  EXPECT_GE(half["strokes"].size(), 4u);
  for (const char* box : {"1,2,3", "0,0,0,1,1,0", "0,0,0,1,1,x", "0,0,0,1,1,1,1", "nan,0,0,1,1,1"})
    EXPECT_EQ(run("reconstruct " + scene_ + " -o " + in_folder("x") + " --box=" + box).status, 2)
        << box;
  EXPECT_EQ(run("reconstruct " + scene_ + " -o " + in_folder("x") + " --box=7,7,7,8,8,8").status, 4)
      << "nothing is there";
}

}  // namespace
}  // namespace sketchsplat
