// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "datasets/types/errors.h"
#include "pipelines/bench/row.h"
#include "tests/datasets/temp_folder.h"

namespace sketchsplat {
namespace {

using testing::HasSubstr;

std::vector<BenchRow> three_rows() {
  return {
      {"a", "fast", {}, {{"F5", 90}, {"F1", 40}, {"acc", 0.5}, {"total", 1}}},
      {"a", "accurate", {}, {{"F5", 95}, {"F1", 50}, {"acc", 0.25}, {"total", 10}}},
      {"b, <c>", "fast", {{"reason", "x"}}, {{"F5", 70}, {"F1", 20}, {"acc", NAN}, {"total", 3}}}};
}

TEST(BenchMeans, AreOverTheScenesOfEachVariantAndLeaveOutWhatIsNoNumber) {
  const std::vector<BenchRow> means = mean_rows(three_rows());
  ASSERT_EQ(means.size(), 2u);
  EXPECT_EQ(means[0].variant, "fast");
  EXPECT_DOUBLE_EQ(means[0].numbers[0].second, 80);
  EXPECT_DOUBLE_EQ(means[0].numbers[2].second, 0.5) << "b has no acc";
  EXPECT_DOUBLE_EQ(means[1].numbers[0].second, 95);
  std::vector<BenchRow> rows = three_rows();
  rows[0].set("axis", "noise");
  rows[0].set("at", "3");
  EXPECT_EQ(mean_rows(rows)[0].scene, "noise 3");
  EXPECT_EQ(mean_rows(rows).size(), 3u);
  EXPECT_TRUE(std::isnan(mean_rows({three_rows()[2]})[0].numbers[2].second));
}

TEST(BenchTable, LinesAreEquallyLongAndShowADashForNoNumber) {
  const std::string table = bench_table(three_rows(), {"F5", "F1", "acc", "total"});
  EXPECT_EQ(table,
            "scene   variant     F5    F1   acc  total\n"
            "a       fast      90.0  40.0  0.50   1.00\n"
            "a       accurate  95.0  50.0  0.25  10.00\n"
            "\n"
            "b, <c>  fast      70.0  20.0     -   3.00\n");
  EXPECT_THAT(bench_table(three_rows(), {"F1"}), HasSubstr("a       fast      40.0\n"));
}

TEST(BenchCsv, QuotesNamesAndLeavesOutWhatIsNoNumber) {
  EXPECT_EQ(bench_csv(three_rows()),
            "scene,variant,reason,F5,F1,acc,total\n"
            "a,fast,,90,40,0.5,1\n"
            "a,accurate,,95,50,0.25,10\n"
            "\"b, <c>\",fast,x,70,20,,3\n");
}

TEST(BenchCsv, ANumberOfLaterRowsStandsWhereItStandsInThem) {
  std::vector<BenchRow> rows = three_rows();
  rows[1].numbers.insert(rows[1].numbers.begin() + 2, {"new", 7});
  EXPECT_THAT(bench_csv(rows), HasSubstr("scene,variant,reason,F5,F1,new,acc,total\n"
                                         "a,fast,,90,40,,0.5,1\n"
                                         "a,accurate,,95,50,7,0.25,10\n"));
}

TEST(BenchJson, IsReadAsItWasWritten) {
  const TempFolder folder;
  Suite suite;
  suite.name = "some";
  const std::string path = folder.file("rows.json"), text = bench_json(three_rows(), suite);
  std::ofstream(path) << text;
  EXPECT_EQ(bench_json(read_bench_json(path), suite), text);
  const nlohmann::json json = nlohmann::json::parse(text);
  EXPECT_EQ(json["suite"], "some");
  EXPECT_EQ(json["rows"][1]["F5"], 95);
  EXPECT_TRUE(json["rows"][2]["acc"].is_null());
}

TEST(BenchJson, ThatIsMissingHoldsNoRowsAndSomethingElseIsRefused) {
  const TempFolder folder;
  const std::string path = folder.file("rows.json");
  EXPECT_TRUE(read_bench_json(path).empty());
  for (const char* text : {"", "{", "[]", R"({"rows": 1})", R"({"rows": [1]})"}) {
    std::ofstream(path) << text;
    EXPECT_THROW(read_bench_json(path), InputError) << text;
  }
}

}  // namespace
}  // namespace sketchsplat
