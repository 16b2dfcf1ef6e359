// SPDX-License-Identifier: MIT
#include "eval/metrics/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "eval/metrics/csv.h"
#include "sketches/io/json.h"

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

Json or_null(double v) { return std::isfinite(v) ? Json(v) : Json(); }

void add_spread(const std::string& of, const Spread& spread, Json* out) {
  (*out)[of + "_median"] = or_null(1000 * spread.median);
  (*out)[of + "_p95"] = or_null(1000 * spread.p95);
  (*out)[of + "_worst"] = or_null(1000 * spread.worst);
}

void add_score(const Score& score, Json* out) {
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
  add_spread("acc", score.to_truth, out);
  add_spread("comp", score.to_prediction, out);
  (*out)["comp_visible"] = or_null(1000 * score.completeness_visible);
  for (const Level& level : score.levels) {
    const std::string at = thousandths(level.threshold);
    (*out)["R" + at + "_visible"] = or_null(level.recall_visible);
    (*out)["F" + at + "_visible"] = or_null(level.f_visible);
  }
}

Json json_of(const Structure& s, bool has_visibility) {
  Json out = {{"strokes", s.strokes}, {"edges", s.edges}, {"matched", s.matched}, {"f", s.f}};
  out["strokes_per_edge"] = s.strokes_per_edge;
  out["precision"] = s.precision;
  out["recall"] = s.recall;
  out["right_type"] = or_null(s.right_type_share);
  const Junctions& j = s.junctions;
  out["junctions"] = {{"predicted", j.predicted},    {"truth", j.truth},
                      {"matched", j.matched},        {"precision", or_null(j.precision)},
                      {"recall", or_null(j.recall)}, {"f", or_null(j.f)}};
  out["duplicated"] = or_null(s.duplicated);
  out["length"] = s.length;
  out["true_length"] = s.true_length;
  out["length_error"] = s.length_error;
  out["parameters"] = or_null(s.parameters);
  out["true_parameters"] = s.true_parameters;
  out["parameters_per_true"] = or_null(s.parameters_per_true);
  out["visible"] = nullptr;
  if (has_visibility) {
    out["visible"] = {{"edges", s.visible_edges},
                      {"matched", s.visible_matched},
                      {"recall", or_null(s.recall_visible)},
                      {"f", or_null(s.f_visible)},
                      {"junctions", j.truth_visible},
                      {"junction_recall", or_null(j.recall_visible)}};
  }
  return out;
}

Json json_of(const std::vector<CurveScore>& curves) {
  Json out = Json::array();
  for (const CurveScore& c : curves) {
    out.push_back({{"name", c.name},
                   {"type", c.type},
                   {"length", c.length},
                   {"share", c.share},
                   {"worst", or_null(1000 * c.worst)}});
  }
  return out;
}

Json json_of(const SolidComparison& c) {
  return {{"valid", c.valid},
          {"volume", c.volume},
          {"true_volume", c.true_volume},
          {"iou", c.iou},
          {"iou_is_exact", c.iou_is_exact},
          {"faces", c.faces},
          {"true_faces", c.true_faces},
          {"face_precision", c.face_precision},
          {"face_recall", c.face_recall},
          {"face_f", c.face_f},
          {"to_truth", c.to_truth},
          {"from_truth", c.from_truth},
          {"largest_distance", c.largest_distance}};
}

bool has_structure(const Evaluation& e) { return e.has_curves && e.has_strokes; }

Json json_of(const Evaluation& e) {
  Json out;
  out["protocol"] = protocol_name(e.protocol);
  out["prediction"] = e.prediction_path;
  out["ground_truth"] = e.truth_path;
  out["lines"] = e.lines;
  out["curves"] = e.curves;
  add_score(e.published, &out);
  add_score(e.fine, &out["fine"]);
  out["structure"] = nullptr;
  if (has_structure(e)) out["structure"] = json_of(e.structure, e.has_visibility);
  if (e.solid) out["solid"] = json_of(*e.solid);
  out["worst_edges"] = json_of(e.worst_edges);
  out["worst_strokes"] = json_of(e.worst_strokes);
  return out;
}

std::string text_of(const Json& document) { return json_text(document, 2) + "\n"; }

// Numbers of the nested objects too, "fine.F5"; what is no number (null) becomes NaN.
void flatten(const Json& object, const std::string& prefix, NamedNumbers* out) {
  for (const auto& [key, value] : object.items()) {
    if (value.is_object()) flatten(value, prefix + key + ".", out);
    if (value.is_number() || value.is_null()) {
      out->emplace_back(prefix + key,
                        value.is_null() ? std::nan("") : value.template get<double>());
    }
  }
}

using Cells = std::vector<std::pair<std::string, std::string>>;  // heading and what is below

// What fits on a wide line: the rest is in the files.
struct Column {
  const char *heading, *key;
  int digits;
};
constexpr Column kColumns[] = {
    {"Acc", "acc", 2},
    {"Comp", "comp", 2},
    {"P20", "P20", 1},
    {"R20", "R20", 1},
    {"F20", "F20", 1},
    {"P10", "P10", 1},
    {"R10", "R10", 1},
    {"F10", "F10", 1},
    {"P5", "P5", 1},
    {"R5", "R5", 1},
    {"F5", "F5", 1},
    {"P2", "P2", 1},
    {"R2", "R2", 1},
    {"F2", "F2", 1},
    {"P1", "P1", 1},
    {"R1", "R1", 1},
    {"F1", "F1", 1},
    {"F5fine", "fine.F5", 1},
    {"F2fine", "fine.F2", 1},
    {"F1fine", "fine.F1", 1},
    {"F5vis", "fine.F5_visible", 1},
    {"strokes", "structure.strokes", 0},
    {"edges", "structure.edges", 0},
    {"matched", "structure.matched", 0},
    {"strF", "structure.f", 1},
    {"type", "structure.right_type", 1},
    {"jncF", "structure.junctions.f", 1},
    {"dup", "structure.duplicated", 1},
    {"par", "structure.parameters_per_true", 2},
};

Cells cells_of(const NamedNumbers& numbers, const std::string& name) {
  const std::map<std::string, double> value_of(numbers.begin(), numbers.end());
  Cells cells;
  if (!name.empty()) cells.emplace_back("scene", name);
  for (const Column& column : kColumns) {
    const auto value = value_of.find(column.key);
    cells.emplace_back(column.heading,
                       value == value_of.end() ? "-" : number(value->second, column.digits));
  }
  return cells;
}

// Rows with the same headings, one below the other.
std::string aligned(const std::vector<Cells>& rows) {
  std::vector<std::string> lines(rows.size() + 1);
  for (size_t c = 0; c < rows[0].size(); ++c) {
    size_t width = rows[0][c].first.size();
    for (const Cells& row : rows) width = std::max(width, row[c].second.size());
    if (c > 0) width += 2;
    const auto append = [&](const std::string& cell, std::string* line) {
      *line += std::string(width - cell.size(), ' ') + cell;
    };
    append(rows[0][c].first, &lines[0]);
    for (size_t r = 0; r < rows.size(); ++r) append(rows[r][c].second, &lines[r + 1]);
  }
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

}  // namespace

std::string to_table(const Evaluation& e, const std::string& name) {
  return aligned({cells_of(numbers_of(e), name)});
}

std::string to_json(const Evaluation& e) { return text_of(json_of(e)); }

NamedNumbers numbers_of(const Evaluation& e) {
  NamedNumbers numbers;
  flatten(json_of(e), "", &numbers);
  return numbers;
}

NamedNumbers mean_of(const std::vector<NamedNumbers>& rows) {
  NamedNumbers means;
  std::map<std::string, std::pair<double, int>> sums;
  for (const NamedNumbers& row : rows) {
    for (const auto& [key, value] : row) {
      const auto [sum, is_new] = sums.try_emplace(key, 0.0, 0);
      if (is_new) means.emplace_back(key, std::nan(""));
      if (!std::isfinite(value)) continue;
      sum->second.first += value;
      ++sum->second.second;
    }
  }
  for (auto& [key, value] : means) {
    const auto& [sum, count] = sums[key];
    if (count > 0) value = sum / count;
  }
  return means;
}

std::string scenes_to_json(const std::vector<SceneEvaluation>& scenes) {
  Json out;
  out["scenes"] = Json::array();
  std::vector<NamedNumbers> rows;
  int missing = 0;
  for (const SceneEvaluation& scene : scenes) {
    Json one = {{"scene", scene.name}, {"missing", scene.missing}};
    one.update(json_of(scene.evaluation));
    out["scenes"].push_back(one);
    rows.push_back(numbers_of(scene.evaluation));
    missing += scene.missing;
  }
  out["missing"] = missing;
  for (const auto& [key, value] : mean_of(rows)) out["mean"][key] = or_null(value);
  return text_of(out);
}

std::string scenes_to_csv(const std::vector<SceneEvaluation>& scenes) {
  std::vector<NamedNumbers> rows;
  for (const SceneEvaluation& scene : scenes) rows.push_back(numbers_of(scene.evaluation));
  rows.push_back(mean_of(rows));
  std::string text = "scene,missing";
  for (const auto& [key, value] : rows.back()) text += "," + key;
  text += "\n";
  for (size_t i = 0; i < rows.size(); ++i) {
    const bool mean = i == scenes.size();
    text += mean ? "mean," : csv_cell(scenes[i].name) + (scenes[i].missing ? ",1" : ",0");
    const std::map<std::string, double> cells(rows[i].begin(), rows[i].end());
    for (const auto& [key, value] : rows.back()) {
      const auto cell = cells.find(key);
      text += ",";
      if (cell != cells.end() && std::isfinite(cell->second)) text += number(cell->second, 6);
    }
    text += "\n";
  }
  return text;
}

std::string strokes_to_csv(const std::vector<SceneEvaluation>& scenes) {
  std::string text = "scene,stroke,kind,length,share,worst\n";
  for (const SceneEvaluation& scene : scenes)
    for (const CurveScore& c : scene.evaluation.strokes)
      text += csv_cell(scene.name) + "," + csv_cell(c.name) + "," + c.type + "," +
              number(c.length, 6) + "," + number(c.share, 3) + "," + number(1000 * c.worst, 3) +
              "\n";
  return text;
}

std::string scenes_to_table(const std::vector<SceneEvaluation>& scenes) {
  // The mean is made of all numbers, then shown as far as the table shows them.
  std::vector<Cells> rows;
  std::vector<NamedNumbers> numbers;
  for (const SceneEvaluation& scene : scenes) {
    numbers.push_back(numbers_of(scene.evaluation));
    rows.push_back(
        cells_of(numbers.back(), scene.missing ? scene.name + " (missing)" : scene.name));
  }
  rows.push_back(cells_of(mean_of(numbers), "mean"));
  return aligned(rows);
}

std::string solid_row(const Evaluation& e) {
  if (!e.solid) return "";
  const SolidComparison& c = *e.solid;
  char text[256];
  std::snprintf(text, sizeof text,
                "solid%s: IoU %s, %d faces of %d: P %.1f, R %.1f, F %.1f; largest distance to the "
                "truth %.2g, from it %.2g\n",
                c.valid ? "" : " (not valid)", number(c.iou, c.iou_is_exact ? 6 : 3).c_str(),
                c.faces, c.true_faces, 100 * c.face_precision, 100 * c.face_recall, 100 * c.face_f,
                c.to_truth, c.from_truth);
  return text;
}

std::string worst_curves(const Evaluation& e) {
  std::string text;
  const auto add = [&](const char* what, const char* share, const CurveScore& c) {
    text += std::string(what) + " " + c.name + (c.type.empty() ? "" : " (" + c.type + ")") +
            ": length " + number(c.length, 3) + ", " + share + " " + number(c.share, 1) +
            ", worst " + number(1000 * c.worst, 1) + "\n";
  };
  for (const CurveScore& c : e.worst_edges) add("edge", "R5", c);
  for (const CurveScore& c : e.worst_strokes) add("stroke", "P5", c);
  return text;
}

}  // namespace sketchsplat
