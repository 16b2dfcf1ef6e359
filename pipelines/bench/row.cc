// SPDX-License-Identifier: MIT
#include "pipelines/bench/row.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "datasets/types/errors.h"
#include "eval/metrics/csv.h"
#include "pipelines/base/version.h"
#include "sketches/io/json.h"

namespace sketchsplat {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

template <typename List, typename Value>
void set_in(List* list, const std::string& name, const Value& value) {
  for (auto& [n, v] : *list) {
    if (n != name) continue;
    v = value;
    return;
  }
  list->push_back({name, value});
}

std::string text_of_number(double value, const char* format) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

// As many digits as mean something.
const char* format_of_number(const std::string& name) {
  if (ends_with(name, "strokes") || name == "peak_mb") return "%.0f";
  const std::string last = name.substr(name.rfind('_') + 1);
  if (last[0] == 'F' || last == "f" || last == "visible" || ends_with(name, "_decode"))
    return "%.1f";
  return "%.2f";
}

// Names of a list of all rows; a new one stands behind the one that it follows in its row.
template <typename List>
std::vector<std::string> names_of(const std::vector<BenchRow>& rows, List BenchRow::*list) {
  std::vector<std::string> names;
  for (const BenchRow& row : rows) {
    auto after = names.begin();
    for (const auto& entry : row.*list) {
      const auto known = std::find(names.begin(), names.end(), entry.first);
      after = known == names.end() ? names.insert(after, entry.first) : known;
      ++after;
    }
  }
  return names;
}

// What a row is averaged with.
BenchRow group_of(const BenchRow& row) {
  const std::string axis = row.label("axis");
  return {axis.empty() ? "mean" : axis + " " + row.label("at"), row.variant, {}, {}};
}

}  // namespace

std::string BenchRow::label(const std::string& name) const {
  for (const auto& [n, text] : labels)
    if (n == name) return text;
  return "";
}

double BenchRow::number(const std::string& name) const {
  for (const auto& [n, value] : numbers)
    if (n == name) return value;
  return kNone;
}

void BenchRow::set(const std::string& name, const std::string& text) {
  set_in(&labels, name, text);
}
void BenchRow::set(const std::string& name, double value) { set_in(&numbers, name, value); }

std::vector<BenchRow> mean_rows(const std::vector<BenchRow>& rows) {
  const std::vector<std::string> names = names_of(rows, &BenchRow::numbers);
  const auto same = [](const BenchRow& a, const BenchRow& b) {
    return a.scene == b.scene && a.variant == b.variant;
  };
  std::vector<BenchRow> means;
  for (const BenchRow& row : rows) {
    const BenchRow group = group_of(row);
    if (std::none_of(means.begin(), means.end(), [&](auto& mean) { return same(mean, group); }))
      means.push_back(group);
  }
  for (BenchRow& mean : means) {
    for (const std::string& name : names) {
      double sum = 0;
      int count = 0;
      for (const BenchRow& row : rows) {
        const double value = same(group_of(row), mean) ? row.number(name) : kNone;
        if (std::isfinite(value)) sum += value, ++count;
      }
      mean.numbers.push_back({name, count ? sum / count : kNone});
    }
  }
  return means;
}

std::string bench_table(const std::vector<BenchRow>& rows,
                        const std::vector<std::string>& columns) {
  std::vector<std::vector<std::string>> lines = {{"scene", "variant"}};
  lines[0].insert(lines[0].end(), columns.begin(), columns.end());
  for (const BenchRow& row : rows) {
    lines.push_back({row.scene, row.variant});
    for (const std::string& name : columns) {
      const double value = row.number(name);
      lines.back().push_back(std::isfinite(value) ? text_of_number(value, format_of_number(name))
                                                  : "-");
    }
  }
  std::vector<size_t> width(lines[0].size());
  for (const auto& line : lines)
    for (size_t c = 0; c < line.size(); ++c) width[c] = std::max(width[c], line[c].size());
  std::string table;
  for (size_t i = 0; i < lines.size(); ++i) {
    if (i > 1 && lines[i][0] != lines[i - 1][0]) table += "\n";
    for (size_t c = 0; c < lines[i].size(); ++c) {
      const std::string space(width[c] - lines[i][c].size(), ' ');
      table += (c ? "  " : "") + (c < 2 ? lines[i][c] + space : space + lines[i][c]);
    }
    table += "\n";
  }
  return table;
}

std::string bench_csv(const std::vector<BenchRow>& rows) {
  const std::vector<std::string> labels = names_of(rows, &BenchRow::labels);
  const std::vector<std::string> numbers = names_of(rows, &BenchRow::numbers);
  std::string csv = "scene,variant";
  for (const auto* names : {&labels, &numbers})
    for (const std::string& name : *names) csv += "," + name;
  csv += "\n";
  for (const BenchRow& row : rows) {
    csv += csv_cell(row.scene) + "," + csv_cell(row.variant);
    for (const std::string& name : labels) csv += "," + csv_cell(row.label(name));
    for (const std::string& name : numbers) {
      const double value = row.number(name);
      csv += "," + (std::isfinite(value) ? text_of_number(value, "%.9g") : "");
    }
    csv += "\n";
  }
  return csv;
}

std::string bench_json(const std::vector<BenchRow>& rows, const Suite& suite) {
  Json out = {{"program", "sketchsplat"},
              {"version", program_version()},
              {"suite", suite.name},
              {"axes", Json::array()},
              {"rows", Json::array()}};
  for (const BenchAxis& axis : suite.axes)
    out["axes"].push_back({{"name", axis.name},
                           {"title", axis.title},
                           {"log", axis.log},
                           {"report", axis.report},
                           {"against", axis.against}});
  for (const BenchRow& row : rows) {
    Json object = {{"scene", row.scene}, {"variant", row.variant}};
    for (const auto& [name, text] : row.labels) object[name] = text;
    for (const auto& [name, value] : row.numbers)
      object[name] = std::isfinite(value) ? Json(value) : Json();
    out["rows"].push_back(object);
  }
  return json_text(out, 1) + "\n";
}

std::vector<BenchRow> read_bench_json(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return {};
  std::vector<BenchRow> rows;
  try {
    const Json json = parse_json<Json>(in, path);  // ordered: columns stay where they are
    for (const Json& object : json.at("rows")) {
      BenchRow row = {object.at("scene"), object.at("variant"), {}, {}};
      for (const auto& [name, value] : object.items()) {
        if (name == "scene" || name == "variant") continue;
        if (value.is_string())
          row.labels.push_back({name, value});
        else
          row.numbers.push_back({name, value.is_number() ? value.get<double>() : kNone});
      }
      rows.push_back(row);
    }
  } catch (const Json::exception& e) {
    throw InputError(path, "results of sketchsplat bench", e.what());
  }
  return rows;
}

}  // namespace sketchsplat
