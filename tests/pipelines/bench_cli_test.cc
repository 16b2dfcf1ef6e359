// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "pipelines/bench.h"
#include "tests/pipelines/program.h"

namespace sketchsplat {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const char kScene[] = "synthesize box --views 12 --resolution 240 --outputs none --quiet --out ";

class Bench : public Program {
 protected:
  static void SetUpTestSuite() {
    scene_ =
        (fs::temp_directory_path() / ("sketchsplat_bench." + std::to_string(getpid()))).string();
    Program::run_in(fs::temp_directory_path(), kScene + scene_);
  }
  static void TearDownTestSuite() { fs::remove_all(scene_); }

  json rows() const {
    return json::parse(text_of_file(folder_ / "bench" / "rows.json")).at("rows");
  }
  Outcome bench(const std::string& arguments) const {
    return run("bench " + arguments + " --quiet --out " + in_folder("bench"));
  }

  static std::string scene_;
};
std::string Bench::scene_;

TEST_F(Bench, ComparesThePresetsInATableAndInFiles) {
  const Outcome o = bench(scene_ + " --presets fast,balanced");
  ASSERT_EQ(o.status, 0) << o.err;
  // Heading, two rows, a blank line, two means.
  EXPECT_EQ(count_lines(o.out), 6) << o.out;
  EXPECT_EQ(count_lines(text_of_file(folder_ / "bench" / "rows.csv")), 3);
  EXPECT_THAT(text_of_file(folder_ / "bench" / "chart.svg"), HasSubstr("</svg>"));
  ASSERT_EQ(rows().size(), 2u);
  for (const json& row : rows()) {
    EXPECT_GT(row["F5"], 90) << o.out;
    EXPECT_GT(row["decode"], 0);
    EXPECT_GT(row["peak_mb"], 1);
    EXPECT_GT(row["cpu"], 0);
    double stages = 0;
    for (const char* stage : {"detect", "lift", "fit", "round", "polish", "write"})
      stages += double(row[stage]);
    EXPECT_LT(stages, row["total"]);
    EXPECT_GT(stages, 0.8 * double(row["total"])) << "nothing long is left out: " << row;
    EXPECT_DOUBLE_EQ(row["total_per_decode"], double(row["total"]) / double(row["decode"]));
  }
}

TEST_F(Bench, SaysWhatEvaluateSays) {
  ASSERT_EQ(bench(scene_ + " --presets fast").status, 0);
  const std::string result = in_folder("bench/" + fs::path(scene_).filename().string() + "/fast");
  ASSERT_EQ(run("evaluate --pred " + result + " --gt " + scene_ + " --json " + in_folder("e.json"))
                .status,
            0);
  const json evaluation = json::parse(text_of_file(folder_ / "e.json")), row = rows()[0];
  EXPECT_NEAR(row["F5"], evaluation["F5"], 1e-9);
  EXPECT_NEAR(row["F1"], evaluation["F1"], 1e-9);
  EXPECT_NEAR(row["Acc"], evaluation["acc"], 1e-9);
  EXPECT_NEAR(row["fine_F2"], evaluation["fine"]["F2"], 1e-9);
  EXPECT_NEAR(row["strokes"], evaluation["structure"]["strokes"], 1e-9);
}

TEST_F(Bench, AblationRunsEveryVariantAndPartsThatAreOffTakeNoTime) {
  ASSERT_EQ(bench(scene_ + " --ablation").status, 0);
  const json all = rows();
  ASSERT_EQ(all.size(), ablation_variants().size());
  const auto of = [&](const std::string& variant) {
    for (const json& row : all)
      if (row["variant"] == variant) return row;
    return json();
  };
  EXPECT_EQ(of("lift and fit only")["round"], 0);
  EXPECT_EQ(of("all but rounds")["round"], 0);
  EXPECT_GT(of("+ raster rounds")["round"], 0);
  EXPECT_NE(of("lift and fit only")["Acc"], of("+ raster rounds")["Acc"]);
  EXPECT_NE(of("lift and fit only")["Acc"], of("all but rounds")["Acc"]);
}

TEST(Ablation, VariantsAreDifferentAndOneIsTheWholeMethod) {
  std::vector<std::string> seen;
  for (const BenchVariant& variant : ablation_variants()) {
    ReconstructOptions options;
    set_options(variant.options, &options);
    Fields fields;
    list_fields(&options, &fields);
    const std::string text = fields_json(fields.list);
    EXPECT_THAT(seen, testing::Not(testing::Contains(text))) << variant.name;
    seen.push_back(text);
  }
  ReconstructOptions whole;
  Fields fields;
  list_fields(&whole, &fields);
  EXPECT_THAT(seen, testing::Contains(fields_json(fields.list)));
}

TEST_F(Bench, WithOverridesPresets) {
  ASSERT_EQ(bench(scene_ + " --presets balanced --with rounds=0,final-polish=false").status, 0);
  EXPECT_EQ(rows()[0]["round"], 0);
}

TEST_F(Bench, RefusesWhatItCannotUse) {
  EXPECT_EQ(bench(scene_ + " --presets fastest").status, kWrongUsage);
  EXPECT_EQ(bench(scene_ + " --presets ,").status, kWrongUsage);
  EXPECT_EQ(bench(scene_ + " --with rounds").status, kWrongUsage);
  EXPECT_EQ(bench(scene_ + " --with no-such=1").status, kWrongUsage);
  EXPECT_EQ(bench(in_folder("nothing")).status, kBadInput);
  const Outcome o = bench(scene());  // has no truth
  EXPECT_EQ(o.status, kBadInput);
  EXPECT_THAT(o.err, HasSubstr("ground truth"));
}

TEST_F(Program, BenchCountsASceneWithTooLittleAsFailed) {
  const std::string poor = scene();
  fs::create_directories(folder_ / "scene" / "gt");
  std::ofstream(folder_ / "scene" / "gt" / "gt.json")
      << R"([{"type": "line", "closed": false, "points": [[0,0,0],[1,0,0]]}])";
  const Outcome o = run("bench " + poor + " --presets fast --out " + in_folder("bench"));
  ASSERT_EQ(o.status, 0) << o.err;
  const json row = json::parse(text_of_file(folder_ / "bench" / "rows.json"))["rows"][0];
  EXPECT_EQ(row["F5"], 0);
  EXPECT_TRUE(row["Acc"].is_null());
}

}  // namespace
}  // namespace sketchsplat
