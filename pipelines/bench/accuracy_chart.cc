// SPDX-License-Identifier: MIT
#include "pipelines/bench/accuracy_chart.h"

#include <algorithm>
#include <cmath>

#include "pipelines/bench/colors.h"

namespace sketchsplat {
namespace {

const char kGrey[] = "#6b7280";

Series series_of(const std::vector<BenchRow>& rows, const std::string& variant,
                 const std::string& quantity) {
  Series s;
  for (const BenchRow& row : rows) {
    if (row.variant != variant) continue;
    s.x.push_back(row.number("total"));
    s.y.push_back(row.number(quantity));
  }
  return s;
}

Series front_of(const std::vector<BenchRow>& means, const std::string& quantity) {
  std::vector<double> x, y;
  for (const BenchRow& row : means) {
    x.push_back(row.number("total"));
    y.push_back(row.number(quantity));
  }
  Series s;
  s.legend = "Pareto front of the means";
  s.color = kGrey;
  s.marker = Marker::kNone;
  s.line = s.dashed = true;
  for (const int i : pareto_front(x, y)) {
    if (!s.x.empty()) s.x.push_back(x[i]), s.y.push_back(s.y.back());  // in steps: nothing between
    s.x.push_back(x[i]);
    s.y.push_back(y[i]);
  }
  return s;
}

Series published_series() {
  Series s;
  s.legend = "published, not measured here: means over 82 models of ABC-NEF, on GPUs";
  s.color = kGrey;
  s.marker = Marker::kDiamond;
  for (const PublishedResult& p : published_results()) {
    s.x.push_back(p.seconds);
    s.y.push_back(p.f5);
    s.labels.push_back(p.method);
  }
  return s;
}

void add_rows(const std::vector<BenchRow>& rows, const std::string& quantity, Panel* panel) {
  const std::vector<BenchRow> means = mean_rows(rows);
  panel->series.push_back(front_of(means, quantity));
  for (size_t v = 0; v < means.size(); ++v) {
    const std::string color = series_color(v);
    Series scenes = series_of(rows, means[v].variant, quantity);
    scenes.color = color;
    panel->series.push_back(scenes);
    Series mean = series_of(means, means[v].variant, quantity);
    mean.color = color;
    mean.marker = Marker::kRing;
    char numbers[96];
    std::snprintf(numbers, sizeof numbers, ": mean F5 %.1f, F1 %.1f, %.2f s", means[v].number("F5"),
                  means[v].number("fine_F1"), means[v].number("total"));
    mean.legend = means[v].variant + numbers;
    panel->series.push_back(mean);
  }
}

}  // namespace

const std::vector<PublishedResult>& published_results() {
  static const std::vector<PublishedResult> list = {
      {"SketchSplat, 2DGS-SN", 91.3, 600},   {"SketchSplat, DexiNed", 50.3, 600},
      {"EdgeGaussians, 2DGS-SN", 80.3, 300}, {"EdgeGaussians, DexiNed", 45.2, 240},
      {"CurveGaussian, DexiNed", 73.7, 180}, {"EMAP, DexiNed", 59.1, 9000},
      {"NEF, DexiNed", 10.8, 5400},
  };
  return list;
}

Chart accuracy_chart(const std::vector<BenchRow>& rows) {
  Chart chart;
  chart.title = "Accuracy against time (dots: scenes, rings: means)";
  chart.width = 1180;
  chart.height = 420;
  const char* const kTime = "seconds per scene";
  Panel all = {70, 60, 440, 310, "With published methods", kTime, "F5 [%]", true};
  all.y_low = 0;
  all.y_high = 103;
  add_rows(rows, "F5", &all);
  all.series.push_back(published_series());
  double high = 30000;
  for (const BenchRow& row : rows) high = std::max(high, 1.5 * row.number("total"));
  all.x_high = high;
  Panel f5 = {580, 60, 250, 310, "The same, closer", kTime, "F5 [%]", true};
  add_rows(rows, "F5", &f5);
  Panel f1 = {900, 60, 250, 310, "Finer (densely sampled)", kTime, "F1 [%]", true};
  add_rows(rows, "fine_F1", &f1);
  for (Panel* panel : {&f5, &f1}) panel->y_high = 101;
  chart.panels = {all, f5, f1};
  return chart;
}

}  // namespace sketchsplat
