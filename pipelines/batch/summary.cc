// SPDX-License-Identifier: MIT
#include "pipelines/batch/summary.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <ostream>

#include "eval/metrics/csv.h"
#include "pipelines/base/version.h"
#include "pipelines/pages/page.h"
#include "sketches/io/json.h"

namespace sketchsplat {
namespace {

const std::vector<std::string> kCounts = {"views",         "curves",  "lines",
                                          "arcs",          "circles", "ellipses",
                                          "elliptic_arcs", "beziers", "junctions"};

std::string state_name(SceneRow::State state) {
  if (state == SceneRow::State::kDone) return "done";
  return state == SceneRow::State::kFailed ? "failed" : "open";
}

double value_of(const Numbers& numbers, const std::string& name) {
  for (const auto& [key, value] : numbers)
    if (key == name) return value;
  return std::nan("");
}

std::string text_of(double value) {
  char text[32] = "";
  if (std::isfinite(value)) std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

// Names of the scores in the order of the first scene that has them.
std::vector<std::string> score_names(const std::vector<SceneRow>& rows) {
  std::vector<std::string> names;
  for (const SceneRow& row : rows)
    for (const auto& [name, value] : row.scores)
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  return names;
}

// Over the scenes that have one.
Numbers mean_scores(const std::vector<SceneRow>& rows) {
  Numbers means;
  for (const std::string& name : score_names(rows)) {
    double sum = 0;
    int n = 0;
    for (const SceneRow& row : rows) {
      const double value = value_of(row.scores, name);
      if (!std::isfinite(value)) continue;
      sum += value;
      ++n;
    }
    means.push_back({name, sum / n});
  }
  return means;
}

Json json_of(const Numbers& numbers) {
  Json object = Json::object();
  for (const auto& [name, value] : numbers) {
    const bool whole = std::isfinite(value) && std::nearbyint(value) == value;
    object[name] = whole ? Json(std::int64_t(value)) : std::isfinite(value) ? Json(value) : Json();
  }
  return object;
}

Json json_of(const SceneRow& row) {
  Json json = {{"scene", row.scene}, {"state", state_name(row.state)}};
  if (row.state == SceneRow::State::kFailed) {
    json["status"] = row.status;
    json["reason"] = row.reason;
  }
  if (row.state != SceneRow::State::kDone) return json;
  json["format"] = row.format;
  json["counts"] = json_of(row.counts);
  json["warnings"] = row.warnings;
  if (!row.scores.empty()) json["scores"] = json_of(row.scores);
  if (!row.note.empty()) json["note"] = row.note;
  return json;
}

// Fit for pages, too.
std::string dump(const Json& json) { return without_tags(json_text(json)); }

// Row by row: all of them as one value would be many times as large as what is written.
// `describe` is what stands for a row.
template <typename Describe>
void write_json(std::ostream& out, const std::vector<SceneRow>& rows,
                const std::string& options_json, Describe describe) {
  const auto count = [&](SceneRow::State state) {
    return std::count_if(rows.begin(), rows.end(),
                         [&](const SceneRow& row) { return row.state == state; });
  };
  Json head = {{"program", "sketchsplat"},
               {"version", program_version()},
               {"commit", program_commit()},
               {"done", count(SceneRow::State::kDone)},
               {"failed", count(SceneRow::State::kFailed)},
               {"open", count(SceneRow::State::kOpen)}};
  head["mean"] = json_of(mean_scores(rows));
  head["options"] = parse_json<Json>(options_json);
  const std::string text = dump(head);
  out << text.substr(0, text.size() - 1) << ",\n\"scenes\":[";
  for (size_t i = 0; i < rows.size(); ++i) out << (i ? ",\n" : "\n") << dump(describe(rows[i]));
  out << "\n]}\n";
}

}  // namespace

SceneRow scene_row(const BatchScene& scene, const SceneKey& key, const BatchStore& store) {
  SceneRow row;
  row.scene = scene.name;
  SceneRecord record;
  if (is_done(store.result(scene.name), key, &record)) {
    row.state = SceneRow::State::kDone;
    row.format = record.format;
    for (const std::string& name : kCounts)
      row.counts.push_back({name, value_of(record.counts, name)});
    row.warnings = record.warnings;
    row.scores = record.scores;
    row.note = record.note;
    return row;
  }
  const RunRecord run = store.run(scene.name);
  if (!run.key.matches(key) || run.status == 0) return row;
  row.state = SceneRow::State::kFailed;
  row.status = run.status;
  row.reason = run.reason;
  return row;
}

void sort_rows(std::vector<SceneRow>* rows) {
  const auto rank = [](const SceneRow& row) {
    return row.state == SceneRow::State::kFailed ? 0 : row.state == SceneRow::State::kOpen ? 1 : 2;
  };
  std::stable_sort(rows->begin(), rows->end(), [&](const SceneRow& a, const SceneRow& b) {
    return rank(a) != rank(b) ? rank(a) < rank(b) : a.scene < b.scene;
  });
}

void write_summary_csv(std::ostream& out, const std::vector<SceneRow>& rows) {
  const std::vector<std::string> scores = score_names(rows);
  out << "scene,state,status,reason,format";
  for (const std::string& name : kCounts) out << "," << name;
  out << ",warnings";
  for (const std::string& name : scores) out << "," << name;
  out << ",note\n";
  for (const SceneRow& row : rows) {
    out << csv_cell(row.scene) << "," << state_name(row.state) << ",";
    if (row.state == SceneRow::State::kFailed) out << row.status;
    out << "," << csv_cell(row.reason) << "," << row.format;
    for (const std::string& name : kCounts) out << "," << text_of(value_of(row.counts, name));
    out << ",";
    if (row.state == SceneRow::State::kDone) out << row.warnings;
    for (const std::string& name : scores) out << "," << text_of(value_of(row.scores, name));
    out << "," << csv_cell(row.note) << "\n";
  }
}

void write_summary_json(std::ostream& out, const std::vector<SceneRow>& rows,
                        const std::string& options_json) {
  write_json(out, rows, options_json, [](const SceneRow& row) { return json_of(row); });
}

void write_summary_html(std::ostream& out, const std::vector<SceneRow>& rows,
                        const std::string& options_json, const BatchStore& store) {
  const std::string page = kIndexPage, mark = "@DATA@";
  const size_t at = page.find(mark);
  out << page.substr(0, at);
  write_json(out, rows, options_json, [&](const SceneRow& row) {
    Json json = json_of(row);
    if (row.state == SceneRow::State::kDone)
      json["thumbnail"] = read_record(store.result(row.scene)).thumbnail;
    return json;
  });
  out << page.substr(at + mark.size());
}

void write_timings_csv(std::ostream& out, const std::vector<BatchScene>& scenes,
                       const BatchStore& store) {
  out << "scene,status,seconds,cpu_seconds,peak_mb,attempts,host,ended\n";
  for (const BatchScene& scene : scenes) {
    const RunRecord run = store.run(scene.name);
    if (run.key.program.empty()) continue;
    out << csv_cell(scene.name) << "," << run.status << "," << text_of(run.seconds) << ","
        << text_of(run.cpu_seconds) << "," << text_of(run.peak_mb) << "," << run.attempts << ","
        << csv_cell(run.host) << "," << run.ended << "\n";
  }
}

}  // namespace sketchsplat
