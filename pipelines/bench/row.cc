// SPDX-License-Identifier: MIT
#include "pipelines/bench/row.h"

#include <algorithm>
#include <array>
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
  if (!std::isfinite(value)) return "-";
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

// As many digits as mean something.
const char* format_of_number(const std::string& name) {
  if (ends_with(name, "strokes") || ends_with(name, "edges") || name == "peak_mb") return "%.0f";
  const std::string last = name.substr(name.rfind('_') + 1);
  if (last[0] == 'F' || last == "f" || name == "total_per_decode") return "%.1f";
  return "%.2f";
}

// Names of the numbers of all rows; a new one stands behind the one that it follows in its row.
template <typename List>
void gather_names(const List& list, std::vector<std::string>* names) {
  auto after = names->begin();
  for (const auto& [name, value] : list) {
    const auto known = std::find(names->begin(), names->end(), name);
    after = known == names->end() ? names->insert(after, name) : known;
    ++after;
  }
}

std::vector<std::string> number_names(const std::vector<BenchRow>& rows) {
  std::vector<std::string> names;
  for (const BenchRow& row : rows) gather_names(row.numbers, &names);
  return names;
}

std::string padded(const std::string& text, size_t width, bool left) {
  const std::string space(width > text.size() ? width - text.size() : 0, ' ');
  return left ? text + space : space + text;
}

BenchRow row_of(const Json& object) {
  BenchRow row;
  for (const auto& [name, value] : object.items()) {
    if (name == "scene" || name == "variant") {
      (name == "scene" ? row.scene : row.variant) = value.is_string() ? value : Json("");
    } else if (value.is_string()) {
      row.labels.push_back({name, value.get<std::string>()});
    } else if (value.is_number()) {
      row.numbers.push_back({name, value.get<double>()});
    } else {
      row.numbers.push_back({name, kNone});
    }
  }
  return row;
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
  const std::vector<std::string> names = number_names(rows);
  std::vector<std::string> variants;
  for (const BenchRow& row : rows)
    if (std::find(variants.begin(), variants.end(), row.variant) == variants.end())
      variants.push_back(row.variant);
  std::vector<BenchRow> means;
  for (const std::string& variant : variants) {
    means.push_back({"mean", variant, {}, {}});
    for (const std::string& name : names) {
      double sum = 0;
      int count = 0;
      for (const BenchRow& row : rows) {
        const double value = row.variant == variant ? row.number(name) : kNone;
        if (std::isfinite(value)) sum += value, ++count;
      }
      means.back().numbers.push_back({name, count ? sum / count : kNone});
    }
  }
  return means;
}

std::string solid_counts(const std::vector<BenchRow>& rows) {
  std::vector<std::pair<std::string, std::array<int, 3>>> counts;
  for (const BenchRow& row : rows) {
    if (!std::isfinite(row.number("solid_right"))) continue;
    auto own = std::find_if(counts.begin(), counts.end(),
                            [&](const auto& c) { return c.first == row.variant; });
    if (own == counts.end()) own = counts.insert(counts.end(), {row.variant, {0, 0, 0}});
    own->second[0] += row.number("solid_right") > 0;
    own->second[1] += row.number("solid_wrong") > 0;
    own->second[2] += row.number("solid_refused") > 0;
  }
  std::string text;
  for (const auto& [variant, n] : counts)
    text += "solids, " + variant + ": " + std::to_string(n[0]) + " right, " + std::to_string(n[1]) +
            " wrong, " + std::to_string(n[2]) + " refused\n";
  return text;
}

std::string bench_table(const std::vector<BenchRow>& rows,
                        const std::vector<std::string>& columns) {
  const std::vector<std::string> names = columns.empty() ? number_names(rows) : columns;
  std::vector<std::vector<std::string>> lines = {{"scene", "variant"}};
  lines[0].insert(lines[0].end(), names.begin(), names.end());
  for (const BenchRow& row : rows) {
    lines.push_back({row.scene, row.variant});
    for (const std::string& name : names)
      lines.back().push_back(text_of_number(row.number(name), format_of_number(name)));
  }
  std::vector<size_t> width(lines[0].size());
  for (const auto& line : lines)
    for (size_t c = 0; c < line.size(); ++c) width[c] = std::max(width[c], line[c].size());
  std::string table;
  for (size_t i = 0; i < lines.size(); ++i) {
    if (i > 1 && lines[i][0] != lines[i - 1][0]) table += "\n";
    for (size_t c = 0; c < lines[i].size(); ++c)
      table += (c ? "  " : "") + padded(lines[i][c], width[c], c < 2);
    table += "\n";
  }
  return table;
}

std::string bench_csv(const std::vector<BenchRow>& rows) {
  std::vector<std::string> labels;
  for (const BenchRow& row : rows) gather_names(row.labels, &labels);
  const std::vector<std::string> numbers = number_names(rows);
  std::string csv = "scene,variant";
  for (const std::string& name : labels) csv += "," + name;
  for (const std::string& name : numbers) csv += "," + name;
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

std::string bench_json(const std::vector<BenchRow>& rows, const std::string& suite) {
  Json out = {{"program", "sketchsplat"},
              {"version", program_version()},
              {"suite", suite},
              {"rows", Json::array()}};
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
  Json json;  // ordered: columns stay where they are
  try {
    json = parse_json<Json>(in, path);
  } catch (const Json::exception&) {
    // said below
  }
  if (!json.is_object() || !json.contains("rows") || !json["rows"].is_array())
    throw InputError(path, "results of sketchsplat bench", "something else");
  std::vector<BenchRow> rows;
  for (const Json& row : json["rows"]) {
    if (!row.is_object() || !row.contains("scene") || !row.contains("variant"))
      throw InputError(path, "rows with scene and variant", json_text(row).substr(0, 60));
    rows.push_back(row_of(row));
  }
  return rows;
}

}  // namespace sketchsplat
