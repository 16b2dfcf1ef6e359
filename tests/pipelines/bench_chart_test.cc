// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "datasets/io/image_io.h"
#include "pipelines/bench/accuracy_chart.h"
#include "pipelines/bench/axis_report.h"
#include "pipelines/bench/chart.h"
#include "tests/datasets/temp_folder.h"

namespace sketchsplat {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(ParetoFront, HoldsWhatNothingBeats) {
  //                                  fast       beaten  better  slower, equal
  EXPECT_THAT(pareto_front({1, 2, 3, 4}, {90, 80, 95, 95}), ElementsAre(0, 2));
  EXPECT_THAT(pareto_front({2, 1, 1}, {80, 70, 75}), ElementsAre(2, 0));
  EXPECT_THAT(pareto_front({1, NAN, 3}, {NAN, 99, 50}), ElementsAre(2));
  EXPECT_TRUE(pareto_front({}, {}).empty());
}

TEST(RoundTicks, AreFewAndInside) {
  EXPECT_THAT(round_ticks(0, 100, 5, false), ElementsAre(0, 20, 40, 60, 80, 100));
  EXPECT_THAT(round_ticks(0.9, 12, 9, true),
              ElementsAre(testing::DoubleEq(1), testing::DoubleEq(2), testing::DoubleEq(5),
                          testing::DoubleEq(10)));
  EXPECT_THAT(round_ticks(0.01, 1e4, 8, true).size(), testing::Le(8u));
  EXPECT_THAT(round_ticks(31, 39, 5, true), ElementsAre(32, 34, 36, 38)) << "no digit is inside";
  EXPECT_TRUE(round_ticks(1, 1, 5, false).empty());
}

TEST(Panel, FitsItsPointsAndStaysInItsFrame) {
  Panel panel = {50, 40, 300, 200, "", "", "", true};
  Series s;
  s.x = {1, 100, 0, NAN};
  s.y = {10, 20, 1e9, 1e9};  // the last two cannot be drawn
  panel.series = {s};
  const Panel p = fitted(panel);
  EXPECT_GT(chart_x(p, 1), 50);
  EXPECT_LT(chart_x(p, 100), 350);
  EXPECT_NEAR(chart_x(p, 10), (chart_x(p, 1) + chart_x(p, 100)) / 2, 1e-9) << "logarithmic";
  EXPECT_LT(chart_y(p, 20), chart_y(p, 10)) << "more is higher";
  EXPECT_LT(p.y_high, 30);
  Panel reversed = p;
  reversed.reversed_x = true;
  EXPECT_NEAR(chart_x(reversed, 1) - 50, 350 - chart_x(p, 1), 1e-9);
  const Panel empty = fitted(Panel());
  EXPECT_LT(empty.x_low, empty.x_high);
  EXPECT_LT(empty.y_low, empty.y_high);
}

std::vector<BenchRow> some_rows() {
  return {{"a", "fast", {}, {{"F5", 90}, {"fine_F1", 40}, {"total", 1}}},
          {"a", "accurate", {}, {{"F5", 95}, {"fine_F1", 50}, {"total", 10}}},
          {"b, <c>", "fast", {}, {{"F5", 70}, {"fine_F1", 20}, {"total", 3}}}};
}

TEST(AccuracyChart, HoldsScenesMeansTheirFrontAndPublishedResultsMarkedAsSuch) {
  const Chart chart = accuracy_chart(some_rows());
  ASSERT_EQ(chart.panels.size(), 3u);
  int dots = 0, rings = 0;
  bool front = false, published = false;
  for (const Series& s : chart.panels[0].series) {
    if (s.marker == Marker::kDot) dots += int(s.x.size());
    if (s.marker == Marker::kRing) rings += int(s.x.size());
    front |= s.legend == "Pareto front of the means" && s.y.back() == 95;
    if (s.marker != Marker::kDiamond) continue;
    published = true;
    EXPECT_THAT(s.legend, HasSubstr("not measured here"));
    EXPECT_EQ(s.labels.size(), s.x.size());
    EXPECT_EQ(s.labels[0], "SketchSplat, 2DGS-SN");
    EXPECT_EQ(s.y[0], 91.3);
    EXPECT_EQ(s.x[0], 600);
  }
  EXPECT_EQ(dots, 3);
  EXPECT_EQ(rings, 2);
  EXPECT_TRUE(front && published);
  // All of it lies in the frame.
  for (const Panel& panel : chart.panels) {
    const Panel p = fitted(panel);
    for (const Series& s : p.series)
      for (size_t i = 0; i < s.x.size(); ++i) {
        EXPECT_GE(chart_x(p, s.x[i]), p.left);
        EXPECT_LE(chart_x(p, s.x[i]), p.left + p.width);
        EXPECT_GE(chart_y(p, s.y[i]), p.top);
        EXPECT_LE(chart_y(p, s.y[i]), p.top + p.height);
      }
  }
}

TEST(DrawChart, WritesTheSamePictureAsSvgAndPng) {
  const TempFolder folder;
  const Chart chart = accuracy_chart(some_rows());
  write_chart(chart, folder.file("chart"));
  const Picture picture = read_picture(folder.file("chart.png"));
  EXPECT_EQ(picture.width(), int(2 * chart.width));
  EXPECT_GT(picture.height(), int(2 * chart.height)) << "the legend stands below";
  const ChartFiles files = draw_chart(chart);
  EXPECT_THAT(files.svg, HasSubstr("</svg>"));
  EXPECT_TRUE(files.png == draw_chart(chart).png) << "no chance, no date";
  EXPECT_FALSE(files.png == draw_chart(accuracy_chart({})).png);
}

// ---------------------------------------------------------------------------------- axes

BenchRow level_row(const std::string& axis, const std::string& part, double level, double f5,
                   const std::string& result) {
  return {part,
          "balanced",
          {{"axis", axis}, {"result", result}, {"status", "0"}},
          {{"F5", f5},
           {"total", 2 * level},
           {"cpu_seconds", level * level},
           {"peak_mb", 30},
           {"level", level}}};
}

Suite suite_with_axes() {
  Suite suite;
  suite.variants = preset_variants({"balanced"});
  for (const char* name : {"noise", "threads", "views"}) {
    suite.axes.emplace_back();
    suite.axes.back().name = suite.axes.back().title = name;
  }
  suite.axes[1].report = AxisReport::kConstant;
  suite.axes[2].report = AxisReport::kExponent;
  suite.axes[2].against = "level";
  return suite;
}

TEST(AxisReport, SaysWhereAccuracyFallsWhatDiffersAndWhatGrows) {
  const Suite suite = suite_with_axes();
  std::vector<BenchRow> rows;
  for (const char* part : {"a", "b"}) {
    rows.push_back(level_row("noise", part, 0, 100, "x"));
    rows.push_back(level_row("noise", part, 4, part[0] == 'a' ? 100 : 80, "y"));
    for (const double threads : {1, 2})
      rows.push_back(level_row("threads", part, threads, 90, "same"));
    for (const double views : {4, 8, 16}) rows.push_back(level_row("views", part, views, 90, "v"));
  }
  const std::vector<AxisResult> limits = axis_results(suite, rows);
  ASSERT_EQ(limits.size(), 2u);
  EXPECT_DOUBLE_EQ(limits[0].f5_drop.value(), 2) << "the mean falls from 100 to 90";
  EXPECT_FALSE(limits[0].visible_drop);
  EXPECT_DOUBLE_EQ(limits[0].f5[1].low, 80);
  EXPECT_DOUBLE_EQ(limits[0].f5_difference, 20);
  EXPECT_FALSE(limits[0].same_results);
  EXPECT_TRUE(limits[1].same_results);
  EXPECT_EQ(limits[1].f5_difference, 0);
  const std::vector<GrowthResult> growth = growth_results(suite, rows);
  ASSERT_EQ(growth.size(), 3u);
  EXPECT_NEAR(growth[0].law.exponent, 1, 1e-9);
  EXPECT_NEAR(growth[1].law.exponent, 2, 1e-9);
  EXPECT_NEAR(growth[2].law.exponent, 0, 1e-9);
  EXPECT_THAT(limits_markdown(limits),
              HasSubstr("| noise | balanced | 2 | 0 | 100.0 | 2 | - | 4 |"));
  EXPECT_THAT(limits_markdown(limits),
              HasSubstr("| threads | balanced | 1 to 2 | 90.0 | 0 | yes |"));
  EXPECT_THAT(limits_csv(limits), HasSubstr("noise,balanced,2,0,100.0,2,,4,90.0,80.0,100.0\n"));
  EXPECT_THAT(growth_markdown(growth),
              HasSubstr("| views | balanced | total | 4 to 16 | 6 | 1.00"));
  const Chart chart = axis_chart({limits[0]});
  ASSERT_EQ(chart.panels.size(), 2u);
  ASSERT_EQ(chart.panels[0].marks.size(), 1u);
  EXPECT_DOUBLE_EQ(chart.panels[0].marks[0].x, 2);
  EXPECT_TRUE(axis_chart({limits[1]}).panels[0].marks.empty());
  EXPECT_EQ(growth_chart(growth).panels.size(), 2u);
}

TEST(AxisReport, AFallThatIsNotReachedIsSaid) {
  const Suite suite = suite_with_axes();
  const std::vector<AxisResult> limits = axis_results(
      suite, {level_row("noise", "a", 0, 100, "x"), level_row("noise", "a", 4, 96, "y")});
  ASSERT_EQ(limits.size(), 1u);
  EXPECT_THAT(limits_markdown(limits), HasSubstr("| not reached |"));
}

}  // namespace
}  // namespace sketchsplat
