// SPDX-License-Identifier: MIT
#include "pipelines/batch/summary.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

#include "eval/csv.h"
#include "pipelines/batch/index_page.h"
#include "pipelines/report.h"
#include "pipelines/version.h"

namespace sketchsplat {
namespace {

using Json = nlohmann::ordered_json;

const std::vector<std::string> kCounts = {"views",    "curves",        "lines",   "arcs",     "circles",
                                          "ellipses", "elliptic_arcs", "beziers", "junctions"};

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

std::vector<SceneRow> failures_first(std::vector<SceneRow> rows) {
  const auto rank = [](const SceneRow& row) {
    return row.state == SceneRow::State::kFailed ? 0 : row.state == SceneRow::State::kOpen ? 1 : 2;
  };
  std::stable_sort(rows.begin(), rows.end(), [&](const SceneRow& a, const SceneRow& b) {
    return std::make_pair(rank(a), a.scene) < std::make_pair(rank(b), b.scene);
  });
  return rows;
}

// Names of the scores in the order of the first scene that has them.
std::vector<std::string> score_names(const std::vector<SceneRow>& rows) {
  std::vector<std::string> names;
  for (const SceneRow& row : rows)
    for (const auto& [name, value] : row.record.scores)
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
      const double value = value_of(row.record.scores, name);
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

Json json_of(const SceneRow& row, bool thumbnail) {
  Json json = {{"scene", row.scene}, {"state", state_name(row.state)}};
  if (row.state == SceneRow::State::kFailed) {
    json["status"] = row.status;
    json["reason"] = row.reason;
  }
  if (row.state != SceneRow::State::kDone) return json;
  json["format"] = row.record.format;
  Numbers counts;
  for (const std::string& name : kCounts) counts.push_back({name, value_of(row.record.counts, name)});
  json["counts"] = json_of(counts);
  json["warnings"] = row.record.warnings;
  if (!row.record.scores.empty()) json["scores"] = json_of(row.record.scores);
  if (!row.record.note.empty()) json["note"] = row.record.note;
  if (thumbnail) json["thumbnail"] = row.record.thumbnail;
  return json;
}

Json summary_of(const std::vector<SceneRow>& rows, const std::string& options_json,
                bool thumbnails) {
  const auto count = [&](SceneRow::State state) {
    return std::count_if(rows.begin(), rows.end(),
                         [&](const SceneRow& row) { return row.state == state; });
  };
  Json json = {{"program", "sketchsplat"},
               {"version", program_version()},
               {"commit", program_commit()},
               {"done", count(SceneRow::State::kDone)},
               {"failed", count(SceneRow::State::kFailed)},
               {"open", count(SceneRow::State::kOpen)}};
  json["mean"] = json_of(mean_scores(rows));
  json["scenes"] = Json::array();
  for (const SceneRow& row : failures_first(rows)) json["scenes"].push_back(json_of(row, thumbnails));
  json["options"] = Json::parse(options_json);
  return json;
}

}  // namespace

SceneRow scene_row(const BatchScene& scene, const SceneKey& key, const BatchStore& store) {
  SceneRow row;
  row.scene = scene.name;
  if (is_done(store.result(scene.name), key, &row.record)) {
    row.state = SceneRow::State::kDone;
    return row;
  }
  const RunRecord run = store.run(scene.name);
  if (!run.key.matches(key) || run.status == 0) return row;
  row.state = SceneRow::State::kFailed;
  row.status = run.status;
  row.reason = run.reason;
  return row;
}

std::string summary_csv(const std::vector<SceneRow>& rows) {
  const std::vector<std::string> scores = score_names(rows);
  std::string text = "scene,state,status,reason,format";
  for (const std::string& name : kCounts) text += "," + name;
  text += ",warnings";
  for (const std::string& name : scores) text += "," + name;
  text += ",note\n";
  for (const SceneRow& row : failures_first(rows)) {
    const bool done = row.state == SceneRow::State::kDone;
    text += csv_cell(row.scene) + "," + state_name(row.state);
    text += row.state == SceneRow::State::kFailed ? "," + std::to_string(row.status) : ",";
    text += "," + csv_cell(row.reason) + "," + row.record.format;
    for (const std::string& name : kCounts) text += "," + text_of(value_of(row.record.counts, name));
    text += "," + (done ? std::to_string(row.record.warnings) : "");
    for (const std::string& name : scores) text += "," + text_of(value_of(row.record.scores, name));
    text += "," + csv_cell(row.record.note) + "\n";
  }
  return text;
}

std::string summary_json(const std::vector<SceneRow>& rows, const std::string& options_json) {
  return summary_of(rows, options_json, false).dump(1, ' ', false, Json::error_handler_t::replace) +
         "\n";
}

std::string summary_html(const std::vector<SceneRow>& rows, const std::string& options_json) {
  return page_with_data(
      kIndexPage,
      summary_of(rows, options_json, true).dump(-1, ' ', false, Json::error_handler_t::replace));
}

std::string timings_csv(const std::vector<BatchScene>& scenes, const BatchStore& store) {
  std::string text = "scene,status,seconds,cpu_seconds,peak_mb,attempts,host,ended\n";
  for (const BatchScene& scene : scenes) {
    const RunRecord run = store.run(scene.name);
    if (run.key.program.empty()) continue;
    text += csv_cell(scene.name) + "," + std::to_string(run.status) + "," + text_of(run.seconds) +
            "," + text_of(run.cpu_seconds) + "," + text_of(run.peak_mb) + "," +
            std::to_string(run.attempts) + "," + csv_cell(run.host) + "," + run.ended + "\n";
  }
  return text;
}

}  // namespace sketchsplat
