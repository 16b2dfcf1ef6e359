// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "pipelines/bench/suite.h"
#include "pipelines/options/options.h"
#include "tests/pipelines/program.h"

namespace sketchsplat {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const char kScene[] = "synthesize box --views 12 --resolution 200 --outputs none --quiet --out ";

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
  EXPECT_EQ(count_lines(o.out), 6) << "heading, two rows, a blank line, two means: " << o.out;
  EXPECT_EQ(count_lines(text_of_file(folder_ / "bench" / "rows.csv")), 3);
  ASSERT_EQ(rows().size(), 2u);
  const json row = rows()[0];
  for (const char* label : {"version", "program", "cpu", "cores", "memory", "threads"})
    EXPECT_FALSE(row[label].get<std::string>().empty()) << label;
  EXPECT_EQ(row["status"], "0");
  EXPECT_EQ(row["views"], 12);
  EXPECT_EQ(row["pixels"], 12 * 200 * 200);
  EXPECT_GT(row["peak_mb"], 1);
  EXPECT_GT(row["cpu_seconds"], 0);
  EXPECT_DOUBLE_EQ(row["total_per_decode"], double(row["total"]) / double(row["decode"]));
  double stages = 0;
  for (const char* stage : {"detect", "hull", "lift", "fit", "round", "polish", "write"})
    stages += double(row[stage]);
  EXPECT_LT(stages, row["total"]);
  EXPECT_GT(stages, 0.6 * double(row["total"])) << "nothing long is left out: " << row;

  const std::string result = in_folder("bench/" + fs::path(scene_).filename().string() + "/fast");
  run("evaluate --pred " + result + " --gt " + scene_ + " --json " + in_folder("e.json"));
  const json evaluation = json::parse(text_of_file(folder_ / "e.json"));
  EXPECT_GT(row["F5"], 90) << o.out;
  EXPECT_NEAR(row["F5"], evaluation["F5"], 1e-9);
  EXPECT_NEAR(row["fine_F2"], evaluation["fine"]["F2"], 1e-9);
  EXPECT_NEAR(row["structure_strokes"], evaluation["structure"]["strokes"], 1e-9);
}

TEST(Ablation, VariantsAreDifferentAndOneIsTheWholeMethod) {
  std::vector<std::string> seen;
  const auto text_of = [](const OptionTexts& texts) {
    ReconstructOptions options;
    set_options(texts, &options);
    Fields fields;
    list_fields(&options, &fields);
    return fields_json(fields.list);
  };
  for (const BenchVariant& variant : ablation_variants()) {
    EXPECT_THAT(seen, testing::Not(testing::Contains(text_of(variant.options)))) << variant.name;
    seen.push_back(text_of(variant.options));
  }
  EXPECT_THAT(seen, testing::Contains(text_of({})));
}

TEST_F(Bench, RowsThatAreThereAreNotRunAgainButOtherOptionsThreadsScenesOrProgramsAreOtherRows) {
  ASSERT_EQ(bench(scene_ + " --presets fast,balanced").status, 0);
  const json first = rows();
  ASSERT_EQ(bench(scene_ + " --presets fast,balanced").status, 0);
  EXPECT_EQ(rows(), first) << "no two runs take equally long";
  ASSERT_EQ(bench(scene_ + " --presets fast").status, 0);
  ASSERT_EQ(rows().size(), 1u) << "what is not asked for is no part of the results";
  EXPECT_EQ(rows()[0], first[0]);

  ASSERT_EQ(bench(scene_ + " --presets fast --with without=polish,close,rounds=0").status, 0);
  EXPECT_NE(rows()[0]["key"], first[0]["key"]);
  EXPECT_FALSE(rows()[0].contains("round")) << "what is off takes no time";
  EXPECT_THAT(std::string(rows()[0]["options"]), HasSubstr("--without polish,close"));
  ASSERT_EQ(bench(scene_ + " --presets fast --threads 3").status, 0);
  const json before = rows()[0];
  EXPECT_NE(before["key"], first[0]["key"]);
  EXPECT_EQ(before["threads"], "3");
  EXPECT_EQ(before["result"], first[0]["result"]) << "but the curves are the same";

  std::string text = text_of_file(folder_ / "bench" / "rows.json");
  const std::string program = before["program"];
  text.replace(text.find(program), program.size(), "another program!");
  std::ofstream(folder_ / "bench" / "rows.json") << text;
  fs::last_write_time(fs::path(scene_) / "meta_data.json", fs::file_time_type::clock::now());
  ASSERT_EQ(bench(scene_ + " --presets fast --threads 3").status, 0);
  EXPECT_EQ(rows()[0]["program"], program);
  EXPECT_NE(rows()[0]["key"], before["key"]);
}

TEST_F(Bench, KilledInTheMiddleItLosesAtMostTheRunningRow) {
  const std::string program = std::string("'") + SKETCHSPLAT_BINARY + "' bench " + scene_ +
                              " --quiet --out " + in_folder("bench");
  // Killed with all its children as soon as there is a row.
  std::ofstream(folder_ / "script") << "setsid " << program << R"( &
pid=$!
until grep -q '"scene"' )" << in_folder("bench/rows.json")
                                    << R"(; do
  kill -0 $pid || exit 1
  sleep 0.02
done
kill -9 -- -$pid
)";
  ASSERT_EQ(std::system(("bash " + in_folder("script") + " >/dev/null 2>&1").c_str()), 0);
  const json killed = rows();
  ASSERT_GE(killed.size(), 1u);
  ASSERT_LT(killed.size(), 3u);
  ASSERT_EQ(bench(scene_).status, 0);
  ASSERT_EQ(rows().size(), 3u);
  for (size_t i = 0; i < killed.size(); ++i) EXPECT_EQ(rows()[i], killed[i]);
}

TEST_F(Bench, ASuiteSynthesizesItsPartsAndReportsItsAxes) {
  std::ofstream(folder_ / "suite.yml") << R"(
presets: [fast]
parts: [box]
synthesize: {views: 12, resolution: 200, blur: 0}
axes:
  - {name: blur, vary: synthesize.blur, levels: [0, 20, 19]}
  - {name: threads, vary: reconstruct.threads, levels: [1, 2], report: constant}
  - {name: growth, vary: synthesize.views, levels: [6, 12], report: exponent, against: pixels}
)";
  const Outcome o = bench("--threads 2 --suite " + in_folder("suite.yml"));
  ASSERT_EQ(o.status, 0) << o.err;
  const json all = rows();
  ASSERT_EQ(all.size(), 6u) << "nothing is left of a box at a blur of 20: the axis ends there";
  EXPECT_GT(all[0]["F5"], 90);
  EXPECT_LT(all[1]["F5"], 20);
  EXPECT_EQ(all[0]["key"], all[3]["key"]) << "equal runs are run once";
  EXPECT_EQ(all[2]["result"], all[3]["result"]) << "for any number of threads";
  EXPECT_EQ(all[4]["pixels"], 6 * 200 * 200);
  EXPECT_THAT(o.out, HasSubstr("\nblur 0     fast "));
  EXPECT_EQ(json::parse(text_of_file(folder_ / "bench" / "rows.json"))["axes"][2]["against"],
            "pixels");
  EXPECT_EQ(count_lines(text_of_file(folder_ / "bench" / "rows.csv")), 7);
  EXPECT_FALSE(fs::exists(folder_ / "bench" / "running")) << "results are kept only if asked for";
}

TEST_F(Bench, ARunThatFailsIsARowAndTheOthersGoOn) {
  std::ofstream(folder_ / "suite.yml") << R"(
presets: [fast]
synthesize: {views: 12, resolution: 200}
scenes: [{part: no-such-part}, {part: box, name: poor, synthesize: {views: 2}}, {part: box}]
)";
  const Outcome o = run("bench --suite " + in_folder("suite.yml") + " --out " + in_folder("bench"));
  ASSERT_EQ(o.status, 0) << o.err;
  const json all = rows();
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0]["status"], "no scene");
  EXPECT_THAT(all[0]["reason"], HasSubstr("no-such-part"));
  EXPECT_FALSE(all[0].contains("F5")) << "not the method's failure";
  EXPECT_EQ(all[1]["status"], "4");
  EXPECT_EQ(all[1]["F5"], 0);
  EXPECT_TRUE(all[1]["acc"].is_null());
  EXPECT_FALSE(all[1]["reason"].get<std::string>().empty());
  EXPECT_GT(all[2]["F5"], 90);
  EXPECT_THAT(o.err, HasSubstr("no-such-part"));
}

TEST_F(Bench, ARunThatTakesTooLongIsEndedAndTriedAgainNextTime) {
  std::ofstream(folder_ / "suite.yml")
      << "timeout: 0.05\npresets: [accurate]\nscenes: [" << scene_ << "]\n";
  ASSERT_EQ(bench("--suite " + in_folder("suite.yml")).status, 0);
  const json first = rows()[0];
  EXPECT_EQ(first["status"], "137");
  EXPECT_THAT(first["reason"], HasSubstr("took longer than"));
  EXPECT_EQ(first["F5"], 0);
  ASSERT_EQ(bench("--suite " + in_folder("suite.yml")).status, 0);
  EXPECT_NE(rows()[0]["total"], first["total"]);
}

TEST_F(Bench, RefusesWhatItCannotUse) {
  EXPECT_EQ(bench(scene_ + " --presets fastest").status, kWrongUsage);
  EXPECT_EQ(bench(scene_ + " --presets ,").status, kWrongUsage);
  EXPECT_EQ(bench(scene_ + " --with rounds").status, kWrongUsage);
  EXPECT_EQ(bench(scene_ + " --with no-such=1").status, kWrongUsage);
  EXPECT_EQ(bench(in_folder("nothing")).status, kBadInput);
  EXPECT_EQ(bench("").status, kWrongUsage);
  EXPECT_EQ(bench(scene_ + " --suite x").status, kWrongUsage);
  EXPECT_EQ(bench("--suite " + in_folder("no.yml")).status, kBadInput);
  fs::create_directories(folder_ / "bench");
  std::ofstream(folder_ / "bench" / "rows.json") << "not ours";
  EXPECT_EQ(bench(scene_).status, kBadInput);
  fs::remove(folder_ / "bench" / "rows.json");
  const Outcome o = bench(scene());  // has no truth
  EXPECT_EQ(o.status, kBadInput);
  EXPECT_THAT(o.err, HasSubstr("ground truth"));
}

}  // namespace
}  // namespace sketchsplat
