// SPDX-License-Identifier: MIT
#include "pipelines/batch/summary.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ostream>
#include <sstream>
#include <tuple>

#include "eval/metrics/csv.h"
#include "pipelines/base/version.h"
#include "pipelines/batch/numbers_json.h"
#include "pipelines/pages/page.h"
#include "sketches/io/json.h"

namespace sketchsplat {
namespace {

using State = SceneRow::State;

const char* name_of(State state) {
  return state == State::kDone ? "done" : state == State::kFailed ? "failed" : "open";
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

// Names of the counts or scores in the order of the first scene that has them.
std::vector<std::string> names_of(const std::vector<SceneRow>& rows,
                                  Numbers SceneRecord::*numbers) {
  std::vector<std::string> names;
  for (const SceneRow& row : rows)
    for (const auto& [name, value] : row.record.*numbers)
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  return names;
}

// Over the scenes that have one.
Numbers mean_scores(const std::vector<SceneRow>& rows) {
  Numbers means;
  for (const std::string& name : names_of(rows, &SceneRecord::scores)) {
    double sum = 0;
    int n = 0;
    for (const SceneRow& row : rows) {
      const double value = value_of(row.record.scores, name);
      if (std::isfinite(value)) sum += value, ++n;
    }
    means.push_back({name, sum / n});
  }
  return means;
}

Json json_of(const SceneRow& row) {
  Json json = {{"scene", row.scene}, {"state", name_of(row.state)}};
  if (row.state == State::kFailed) {
    json["status"] = row.status;
    json["reason"] = row.reason;
  }
  if (row.state != State::kDone) return json;
  json["format"] = row.record.format;
  json["counts"] = numbers_json(row.record.counts);
  json["warnings"] = row.record.warnings;
  if (!row.record.scores.empty()) json["scores"] = numbers_json(row.record.scores);
  if (!row.record.note.empty()) json["note"] = row.record.note;
  return json;
}

// Fit for pages, too.
std::string line_of(const Json& json) { return without_tags(json_text(json)); }

}  // namespace

SceneRow scene_row(const BatchScene& scene, const SceneKey& key, const BatchStore& store) {
  SceneRow row;
  row.scene = scene.name;
  if (is_done(store.result(scene.name), key, &row.record)) {
    row.state = State::kDone;
    return row;
  }
  const RunRecord run = store.run(scene.name);
  if (!run.key.matches(key) || run.status == 0) return row;
  row.state = State::kFailed;
  row.status = run.status;
  row.reason = run.reason;
  return row;
}

void sort_rows(std::vector<SceneRow>* rows) {
  std::sort(rows->begin(), rows->end(), [](const SceneRow& a, const SceneRow& b) {
    return std::tie(a.state, a.scene) < std::tie(b.state, b.scene);
  });
}

int count_rows(const std::vector<SceneRow>& rows, State state) {
  return int(std::count_if(rows.begin(), rows.end(),
                           [&](const SceneRow& row) { return row.state == state; }));
}

void write_summary_csv(std::ostream& out, const std::vector<SceneRow>& rows) {
  const std::vector<std::string> counts = names_of(rows, &SceneRecord::counts);
  const std::vector<std::string> scores = names_of(rows, &SceneRecord::scores);
  out << "scene,state,status,reason,format";
  for (const std::string& name : counts) out << "," << name;
  out << ",warnings";
  for (const std::string& name : scores) out << "," << name;
  out << ",note\n";
  for (const SceneRow& row : rows) {
    out << csv_cell(row.scene) << "," << name_of(row.state) << ",";
    if (row.state == State::kFailed) out << row.status;
    out << "," << csv_cell(row.reason) << "," << row.record.format;
    for (const std::string& name : counts) out << "," << text_of(value_of(row.record.counts, name));
    out << ",";
    if (row.state == State::kDone) out << row.record.warnings;
    for (const std::string& name : scores) out << "," << text_of(value_of(row.record.scores, name));
    out << "," << csv_cell(row.record.note) << "\n";
  }
}

// Row by row: all of them as one value would be many times as large as what is written.
void write_summary_json(std::ostream& out, const std::vector<SceneRow>& rows,
                        const std::string& options_json) {
  Json head = {{"program", "sketchsplat"},
               {"version", program_version()},
               {"commit", program_commit()},
               {"done", count_rows(rows, State::kDone)},
               {"failed", count_rows(rows, State::kFailed)},
               {"open", count_rows(rows, State::kOpen)}};
  head["mean"] = numbers_json(mean_scores(rows));
  head["options"] = parse_json<Json>(options_json);
  const std::string text = line_of(head);
  out << text.substr(0, text.size() - 1) << ",\n\"scenes\":[";
  for (size_t i = 0; i < rows.size(); ++i) out << (i ? ",\n" : "\n") << line_of(json_of(rows[i]));
  out << "\n]}\n";
}

void write_summary_html(std::ostream& out, const std::vector<SceneRow>& rows,
                        const std::string& options_json) {
  const std::string page = kIndexPage, mark = "@DATA@";
  const size_t at = page.find(mark);
  out << page.substr(0, at);
  write_summary_json(out, rows, options_json);
  out << page.substr(at + mark.size());
}

void write_timings_csv(std::ostream& out, const std::vector<SceneRow>& rows,
                       const BatchStore& store) {
  out << "scene,status,seconds,cpu_seconds,peak_mb,attempts,host,ended\n";
  for (const SceneRow& row : rows) {
    const RunRecord run = store.run(row.scene);
    if (run.key.program.empty()) continue;
    out << csv_cell(row.scene) << "," << run.status << "," << text_of(run.seconds) << ","
        << text_of(run.cpu_seconds) << "," << text_of(run.peak_mb) << "," << run.attempts << ","
        << csv_cell(run.host) << "," << run.ended << "\n";
  }
}

}  // namespace sketchsplat
