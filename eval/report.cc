// SPDX-License-Identifier: MIT
#include "eval/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

using nlohmann::ordered_json;

namespace sketchsplat {
namespace {

std::string number(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  char text[64];
  std::snprintf(text, sizeof(text), "%.*f", digits, value);
  return text;
}

// 0.005 -> "5": the thousandths that the tables call a threshold by.
std::string thousandths(double threshold) {
  char text[32];
  std::snprintf(text, sizeof(text), "%g", 1000 * threshold);
  return text;
}

void add_score(const Score& score, ordered_json* out) {
  const auto or_null = [](double v) { return std::isfinite(v) ? ordered_json(v) : ordered_json(); };
  (*out)["samples"] = score.samples;
  (*out)["truth_samples"] = score.truth_samples;
  (*out)["acc"] = or_null(1000 * score.accuracy);
  (*out)["comp"] = or_null(1000 * score.completeness);
  (*out)["chamfer"] = or_null(1000 * (score.accuracy + score.completeness));
  for (const Level& level : score.levels) {
    const std::string at = thousandths(level.threshold);
    (*out)["P" + at] = level.precision;
    (*out)["R" + at] = level.recall;
    (*out)["F" + at] = level.f;
  }
}

bool has_structure(const Evaluation& e) { return e.has_curves && e.has_strokes; }

}  // namespace

std::string to_table(const Evaluation& e, const std::string& name) {
  std::vector<std::pair<std::string, std::string>> cells;
  if (!name.empty()) cells.emplace_back("scene", name);
  cells.emplace_back("Acc", number(1000 * e.published.accuracy, 2));
  cells.emplace_back("Comp", number(1000 * e.published.completeness, 2));
  for (const Level& level : e.published.levels) {
    const std::string at = thousandths(level.threshold);
    cells.emplace_back("P" + at, number(level.precision, 1));
    cells.emplace_back("R" + at, number(level.recall, 1));
    cells.emplace_back("F" + at, number(level.f, 1));
  }
  for (const Level& level : e.fine.levels) {
    cells.emplace_back("F" + thousandths(level.threshold) + "fine", number(level.f, 1));
  }
  const Structure& s = e.structure;
  cells.emplace_back("strokes", e.has_strokes ? std::to_string(s.strokes) : "-");
  cells.emplace_back("edges", e.has_curves ? std::to_string(s.edges) : "-");
  cells.emplace_back("matched", has_structure(e) ? std::to_string(s.matched) : "-");
  cells.emplace_back("strF", has_structure(e) ? number(s.f, 1) : "-");
  std::string heading, row;
  for (const auto& [head, value] : cells) {
    const size_t width = std::max(head.size(), value.size()) + (row.empty() ? 0 : 2);
    heading += std::string(width - head.size(), ' ') + head;
    row += std::string(width - value.size(), ' ') + value;
  }
  return heading + "\n" + row + "\n";
}

std::string to_json(const Evaluation& e) {
  ordered_json out;
  out["protocol"] = protocol_name(e.protocol);
  out["prediction"] = e.prediction_path;
  out["ground_truth"] = e.truth_path;
  out["lines"] = e.lines;
  out["curves"] = e.curves;
  add_score(e.published, &out);
  add_score(e.fine, &out["fine"]);
  if (has_structure(e)) {
    const Structure& s = e.structure;
    out["structure"] = {
        {"strokes", s.strokes}, {"edges", s.edges}, {"matched", s.matched}, {"f", s.f}};
    out["structure"]["strokes_per_edge"] = double(s.strokes) / s.edges;
  } else {
    out["structure"] = nullptr;
  }
  return out.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace sketchsplat
