// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "pipelines/bench/axis_report.h"
#include "pipelines/bench/colors.h"

namespace sketchsplat {
namespace {

std::string text_of(double value, const char* format) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

Series level_series(const AxisResult& r, const std::vector<Summary>& values,
                    const std::string& color) {
  Series s;
  s.color = color;
  s.line = true;
  s.x = r.levels;
  for (const Summary& v : values) {
    s.y.push_back(v.mean);
    s.low.push_back(v.low);
    s.high.push_back(v.high);
  }
  return s;
}

bool has_numbers(const std::vector<Summary>& values) {
  return std::any_of(values.begin(), values.end(), [](const Summary& s) { return s.count > 0; });
}

// Levels that are not positive have no place on a logarithmic axis.
bool log_levels(const AxisResult& r) {
  return r.axis->log &&
         std::all_of(r.levels.begin(), r.levels.end(), [](double v) { return v > 0; });
}

void set_levels(const AxisResult& r, Panel* panel) {
  panel->log_x = log_levels(r);
  panel->reversed_x = r.levels.size() > 1 && r.levels.front() > r.levels.back();
  panel->x_ticks = r.levels;
}

}  // namespace

Chart axis_chart(const std::vector<AxisResult>& results) {
  Chart chart;
  const AxisResult& first = results.at(0);
  chart.title = first.axis->title;
  chart.width = 640;
  chart.height = 560;
  Panel f5 = {70,
              60,
              540,
              290,
              "F5: mean over the parts, band: worst and best part",
              first.axis->title,
              "F5 [%]"};
  f5.y_low = 0;
  f5.y_high = 102;
  Panel time = {70, 410, 540, 95, "Time", first.axis->title, "s per scene"};
  time.y_low = 0;
  set_levels(first, &f5);
  set_levels(first, &time);
  for (size_t v = 0; v < results.size(); ++v) {
    const AxisResult& r = results[v];
    const std::string of = results.size() > 1 ? ", " + r.variant : "";
    const std::string color = series_color(2 * v), other = series_color(2 * v + 1);
    Series all = level_series(r, r.f5, color);
    all.legend = "F5" + of;
    f5.series.push_back(all);
    if (has_numbers(r.visible)) {
      Series seen = level_series(r, r.visible, other);
      seen.legend = "F5 of what two views see" + of;
      seen.low.clear();
      seen.high.clear();
      seen.dashed = true;
      f5.series.push_back(seen);
    }
    if (r.f5_drop && r.axis->report == AxisReport::kDrop)
      f5.marks.push_back({*r.f5_drop, "5 lower at " + text_of(*r.f5_drop, "%.3g") + of, color});
    time.series.push_back(level_series(r, r.seconds, color));
  }
  chart.panels = {f5, time};
  return chart;
}

Chart growth_chart(const std::vector<GrowthResult>& results) {
  Chart chart;
  chart.title = "Time and memory against " + results.at(0).axis->title;
  chart.width = 900;
  chart.height = 430;
  Panel time = {80, 60, 340, 310, "Time", results[0].axis->title, "s", true, true};
  Panel memory = {530, 60, 340, 310, "Peak memory", results[0].axis->title, "MB", true, true};
  size_t color = 0;
  for (const GrowthResult& g : results) {
    Series dots;
    dots.color = series_color(color++);
    dots.x = g.x;
    dots.y = g.y;
    Series law;
    law.color = dots.color;
    law.marker = Marker::kNone;
    law.line = true;
    const char* const what = g.quantity == "total"         ? "time"
                             : g.quantity == "cpu_seconds" ? "CPU time"
                                                           : "memory";
    law.legend = g.variant + ", " + what + ": exponent " + text_of(g.law.exponent, "%.2f") + " ± " +
                 text_of(g.law.error, "%.2f");
    const Summary x = summary_of(g.x);
    for (const double v : {x.low, x.high}) {
      law.x.push_back(v);
      law.y.push_back(g.law.factor * std::pow(v, g.law.exponent));
    }
    Panel& panel = g.quantity == "peak_mb" ? memory : time;
    panel.series.push_back(dots);
    panel.series.push_back(law);
  }
  chart.panels = {time, memory};
  return chart;
}

}  // namespace sketchsplat
