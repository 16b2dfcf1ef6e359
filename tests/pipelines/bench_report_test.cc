// SPDX-License-Identifier: MIT
#include "pipelines/bench_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace sketchsplat {
namespace {

using testing::HasSubstr;

std::vector<BenchRow> three_rows() {
  return {{"a", "fast", {{"F5", 90}, {"F1", 40}, {"Acc", 0.5}, {"total", 1}}},
          {"a", "accurate", {{"F5", 95}, {"F1", 50}, {"Acc", 0.25}, {"total", 10}}},
          {"b, <c>", "fast", {{"F5", 70}, {"F1", 20}, {"Acc", NAN}, {"total", 3}}}};
}

TEST(BenchMeans, AreOverTheScenesOfEachVariantAndLeaveOutWhatIsNoNumber) {
  const std::vector<BenchRow> means = mean_rows(three_rows());
  ASSERT_EQ(means.size(), 2u);
  EXPECT_EQ(means[0].variant, "fast");
  EXPECT_DOUBLE_EQ(means[0].numbers[0].second, 80);
  EXPECT_DOUBLE_EQ(means[0].numbers[2].second, 0.5) << "b has no Acc";
  EXPECT_DOUBLE_EQ(means[1].numbers[0].second, 95);
  EXPECT_TRUE(mean_rows({}).empty());
  EXPECT_TRUE(std::isnan(mean_rows({three_rows()[2]})[0].numbers[2].second));
}

TEST(BenchTable, LinesAreEquallyLongAndShowADashForNoNumber) {
  const std::string table = bench_table(three_rows());
  EXPECT_EQ(table,
            "scene   variant     F5    F1   Acc  total\n"
            "a       fast      90.0  40.0  0.50   1.00\n"
            "a       accurate  95.0  50.0  0.25  10.00\n"
            "\n"
            "b, <c>  fast      70.0  20.0     -   3.00\n");
  EXPECT_THAT(bench_table(three_rows(), {"F1"}), HasSubstr("a       fast      40.0\n"));
  EXPECT_EQ(bench_table({}), "scene  variant\n");
}

TEST(BenchCsv, QuotesNamesAndLeavesOutWhatIsNoNumber) {
  EXPECT_EQ(bench_csv(three_rows()),
            "scene,variant,F5,F1,Acc,total\n"
            "a,fast,90,40,0.5,1\n"
            "a,accurate,95,50,0.25,10\n"
            "\"b, <c>\",fast,70,20,,3\n");
}

TEST(BenchJson, HoldsTheRowsAndTheOptionsTheyShare) {
  const nlohmann::json json = nlohmann::json::parse(bench_json(three_rows(), {{"rounds", "2"}}));
  EXPECT_EQ(json["options"]["rounds"], "2");
  EXPECT_EQ(json["rows"][1]["F5"], 95);
  EXPECT_TRUE(json["rows"][2]["Acc"].is_null());
}

double attribute(const std::string& svg, const std::string& title, const std::string& name) {
  const size_t end = svg.find("<title>" + title), begin = svg.rfind("<circle", end);
  const size_t at = svg.find(name + "=\"", begin);
  return at < end ? std::stod(svg.substr(at + name.size() + 2)) : NAN;
}

TEST(BenchChart, TimeIsLogarithmicAndBetterIsHigher) {
  std::vector<BenchRow> rows = three_rows();
  rows[2].numbers[3].second = std::sqrt(10.0);  // half way from 1 s to 10 s
  const std::string svg = bench_chart(rows);
  const double left = attribute(svg, "a, fast", "cx"), right = attribute(svg, "a, accurate", "cx");
  EXPECT_LT(left, right);
  EXPECT_NEAR(attribute(svg, "b, &lt;c&gt;, fast", "cx"), (left + right) / 2, 0.01);
  EXPECT_LT(attribute(svg, "a, accurate", "cy"), attribute(svg, "a, fast", "cy"));
  for (const char* title : {"a, fast", "a, accurate", "b, &lt;c&gt;, fast", "mean, fast"}) {
    EXPECT_GT(attribute(svg, title, "cy"), 40) << title << " lies inside its panel";
    EXPECT_LT(attribute(svg, title, "cy"), 340) << title;
  }
  EXPECT_THAT(bench_chart({}), HasSubstr("</svg>"));
}

}  // namespace
}  // namespace sketchsplat
