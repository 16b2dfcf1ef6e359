// SPDX-License-Identifier: MIT
#include "pipelines/bench/axis_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace sketchsplat {
namespace {

constexpr double kDrop = 5;  // [per cent]
const char* const kVisible = "F5_visible";

std::string text_of(double value, const char* format = "%.1f") {
  if (!std::isfinite(value)) return "-";
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::vector<const BenchRow*> rows_of(const std::vector<BenchRow>& rows, const BenchAxis& axis,
                                     const std::string& variant) {
  std::vector<const BenchRow*> chosen;
  for (const BenchRow& row : rows)
    if (row.label("axis") == axis.name && row.variant == variant) chosen.push_back(&row);
  return chosen;
}

std::vector<double> numbers_at(const std::vector<const BenchRow*>& rows, double level,
                               const std::string& name) {
  std::vector<double> numbers;
  for (const BenchRow* row : rows)
    if (row->number("level") == level) numbers.push_back(row->number(name));
  return numbers;
}

std::vector<double> means(const std::vector<Summary>& summaries) {
  std::vector<double> all;
  for (const Summary& s : summaries) all.push_back(s.mean);
  return all;
}

// How much each part's results differ over the levels.
void compare_levels(const std::vector<const BenchRow*>& rows, AxisResult* result) {
  std::map<std::string, std::vector<const BenchRow*>> parts;
  for (const BenchRow* row : rows) parts[row->scene].push_back(row);
  for (const auto& [scene, levels] : parts) {
    std::vector<double> f5;
    for (const BenchRow* row : levels) {
      f5.push_back(row->number("F5"));
      result->same_results &= row->label("result") == levels[0]->label("result");
    }
    const Summary s = summary_of(f5);
    if (s.count) result->f5_difference = std::max(result->f5_difference, s.high - s.low);
  }
}

AxisResult axis_result(const BenchAxis& axis, const std::string& variant,
                       const std::vector<const BenchRow*>& rows) {
  AxisResult result;
  result.axis = &axis;
  result.variant = variant;
  for (const BenchRow* row : rows) {
    const double level = row->number("level");
    if (std::find(result.levels.begin(), result.levels.end(), level) == result.levels.end())
      result.levels.push_back(level);
  }
  for (const double level : result.levels) {
    result.f5.push_back(summary_of(numbers_at(rows, level, "F5")));
    result.visible.push_back(summary_of(numbers_at(rows, level, kVisible)));
    result.seconds.push_back(summary_of(numbers_at(rows, level, "total")));
  }
  result.f5_drop = drop_point(result.levels, means(result.f5), kDrop, axis.log);
  result.visible_drop = drop_point(result.levels, means(result.visible), kDrop, axis.log);
  compare_levels(rows, &result);
  return result;
}

// "never" where even the last level does not do it.
std::string drop_text(const std::optional<double>& point, const std::vector<Summary>& values) {
  if (point) return text_of(*point, "%.3g");
  return summary_of(means(values)).count ? "not reached" : "-";
}

// One line per axis, the cells of both tables.
using Cells = std::vector<std::string>;

Cells limit_cells(const AxisResult& r) {
  int parts = 0;
  for (const Summary& s : r.f5) parts = std::max(parts, s.count);
  return {r.axis->title,
          r.variant,
          std::to_string(parts),
          text_of(r.levels.front(), "%g"),
          text_of(r.f5.front().mean),
          drop_text(r.f5_drop, r.f5),
          drop_text(r.visible_drop, r.visible),
          text_of(r.levels.back(), "%g"),
          text_of(r.f5.back().mean),
          text_of(r.f5.back().low),
          text_of(r.f5.back().high)};
}

Cells constant_cells(const AxisResult& r) {
  return {r.axis->title,
          r.variant,
          text_of(r.levels.front(), "%g") + " to " + text_of(r.levels.back(), "%g"),
          text_of(r.f5.front().mean),
          text_of(r.f5_difference, "%.2g"),
          r.same_results ? "yes" : "no"};
}

Cells growth_cells(const GrowthResult& g) {
  const Summary x = summary_of(g.x);
  return {g.axis->title,
          g.variant,
          g.quantity,
          text_of(x.low, "%.4g") + " to " + text_of(x.high, "%.4g"),
          std::to_string(g.law.points),
          text_of(g.law.exponent, "%.2f"),
          text_of(g.law.error, "%.2f"),
          text_of(g.law.factor, "%.3g")};
}

std::string markdown(const Cells& heading, const std::vector<Cells>& lines) {
  std::string text = "|", rule = "|";
  for (const std::string& cell : heading) text += " " + cell + " |", rule += "---|";
  text += "\n" + rule + "\n";
  for (const Cells& line : lines) {
    text += "|";
    for (const std::string& cell : line) text += " " + cell + " |";
    text += "\n";
  }
  return text;
}

std::string csv(const Cells& heading, const std::vector<Cells>& lines) {
  std::string text;
  const auto add = [&](const Cells& line) {
    for (size_t c = 0; c < line.size(); ++c) {
      const bool quote = line[c].find_first_of(",\"") != std::string::npos;
      text += (c ? "," : "") + (quote ? '"' + line[c] + '"' : line[c] == "-" ? "" : line[c]);
    }
    text += "\n";
  };
  add(heading);
  for (const Cells& line : lines) add(line);
  return text;
}

const Cells kLimitHeading = {"what is varied",     "variant",  "parts",
                             "harmless",           "F5 there", "F5 falls by 5 at",
                             "visible F5 by 5 at", "last",     "F5 there (mean)",
                             "worst part",         "best part"};
const Cells kConstantHeading = {"what must not matter",     "variant",   "levels", "F5",
                                "largest difference of F5", "same bytes"};
const Cells kGrowthHeading = {"against", "variant",  "quantity",  "range",
                              "runs",    "exponent", "its error", "factor"};

std::vector<Cells> lines_of(const std::vector<AxisResult>& results, AxisReport report) {
  std::vector<Cells> lines;
  for (const AxisResult& r : results)
    if (r.axis->report == report)
      lines.push_back(report == AxisReport::kDrop ? limit_cells(r) : constant_cells(r));
  return lines;
}

std::vector<Cells> lines_of(const std::vector<GrowthResult>& results) {
  std::vector<Cells> lines;
  for (const GrowthResult& g : results) lines.push_back(growth_cells(g));
  return lines;
}

}  // namespace

std::vector<AxisResult> axis_results(const Suite& suite, const std::vector<BenchRow>& rows) {
  std::vector<AxisResult> results;
  for (const BenchAxis& axis : suite.axes) {
    if (axis.report == AxisReport::kExponent) continue;
    for (const BenchVariant& variant : suite.variants) {
      const std::vector<const BenchRow*> chosen = rows_of(rows, axis, variant.name);
      if (!chosen.empty()) results.push_back(axis_result(axis, variant.name, chosen));
    }
  }
  return results;
}

std::vector<GrowthResult> growth_results(const Suite& suite, const std::vector<BenchRow>& rows) {
  std::vector<GrowthResult> results;
  for (const BenchAxis& axis : suite.axes) {
    if (axis.report != AxisReport::kExponent) continue;
    for (const BenchVariant& variant : suite.variants) {
      for (const char* quantity : {"total", "cpu_seconds", "peak_mb"}) {
        GrowthResult g = {&axis, variant.name, quantity, {}, {}, {}};
        for (const BenchRow* row : rows_of(rows, axis, variant.name)) {
          if (row->label("status") != "0") continue;  // a failure takes no time to speak of
          g.x.push_back(axis.against == "level" ? row->number("level") : row->number(axis.against));
          g.y.push_back(row->number(quantity));
        }
        g.law = fit_power_law(g.x, g.y);
        if (!g.x.empty()) results.push_back(g);
      }
    }
  }
  return results;
}

std::string limits_markdown(const std::vector<AxisResult>& results) {
  const std::vector<Cells> drops = lines_of(results, AxisReport::kDrop),
                           constant = lines_of(results, AxisReport::kConstant);
  std::string text;
  if (!drops.empty()) text += markdown(kLimitHeading, drops);
  if (!drops.empty() && !constant.empty()) text += "\n";
  if (!constant.empty()) text += markdown(kConstantHeading, constant);
  return text;
}

std::string limits_csv(const std::vector<AxisResult>& results) {
  const std::vector<Cells> drops = lines_of(results, AxisReport::kDrop),
                           constant = lines_of(results, AxisReport::kConstant);
  std::string text;
  if (!drops.empty()) text += csv(kLimitHeading, drops);
  if (!drops.empty() && !constant.empty()) text += "\n";
  if (!constant.empty()) text += csv(kConstantHeading, constant);
  return text;
}

std::string growth_markdown(const std::vector<GrowthResult>& results) {
  return markdown(kGrowthHeading, lines_of(results));
}

std::string growth_csv(const std::vector<GrowthResult>& results) {
  return csv(kGrowthHeading, lines_of(results));
}

}  // namespace sketchsplat
