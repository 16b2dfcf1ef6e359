// SPDX-License-Identifier: MIT
#include "pipelines/batch/record.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "datasets/types/errors.h"
#include "pipelines/base/atomic_file.h"
#include "pipelines/batch/numbers_json.h"
#include "sketches/io/json.h"

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;
constexpr char kName[] = "/batch.json";

// What summaries show: of report.json's counts, and of `evaluate --json`.
constexpr char kCounts[] =
    "views curves lines arcs circles ellipses elliptic_arcs beziers junctions";
constexpr char kScores[] =
    "F5 F10 F20 acc comp fine/F5 fine/F2 fine/F1 structure/f structure/strokes_per_edge "
    "structure/right_type";

std::string dump(const Json& json) { return json_text(json, 1) + "\n"; }

Json read_json(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(path, "a file of sketchsplat", "nothing to read");
  try {
    return parse_json<Json>(in, path);
  } catch (const Json::exception& e) {
    throw InputError(path, "a file of sketchsplat", e.what());
  }
}

Numbers numbers_in(const Json& object) {
  Numbers numbers;
  for (const auto& [name, value] : object.items())
    numbers.push_back(
        {name, value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN()});
  return numbers;
}

Json json_of(const SceneKey& key) { return {{"program", key.program}, {"input", key.input}}; }

SceneKey key_in(const Json& json) { return {json.at("program"), json.at("input")}; }

// What an object holds of these paths, with "." for "/" in their names.
Numbers numbers_at(const Json& object, const char* paths) {
  Numbers numbers;
  std::istringstream in(paths);
  for (std::string path; in >> path;) {
    const Json::json_pointer pointer("/" + path);
    if (!object.contains(pointer) || !object[pointer].is_number()) continue;
    std::replace(path.begin(), path.end(), '/', '.');
    numbers.push_back({path, object[pointer].get<double>()});
  }
  return numbers;
}

// A record that is not there, or that is broken, has no key.
SceneRecord read_record(const std::string& folder) {
  SceneRecord record;
  try {
    const Json json = read_json(folder + kName);
    record.format = json.at("format");
    record.counts = numbers_in(json.at("counts"));
    record.warnings = json.at("warnings");
    record.scores = numbers_in(json.at("scores"));
    record.note = json.at("note");
    for (const auto& [name, size] : json.at("files").items())
      record.files.push_back({name, size.get_ref<const Json::number_unsigned_t&>()});
    record.key = key_in(json.at("key"));
  } catch (const std::exception&) {
    return {};
  }
  return record;
}

}  // namespace

SceneRecord make_record(const std::string& folder, const std::string& evaluation) {
  SceneRecord record;
  try {
    const Json report = read_json(folder + "/report.json");
    record.format = report.at("scene").at("format");
    record.counts = numbers_at(report.at("counts"), kCounts);
    record.warnings = int(report.at("warnings").size());
    if (!evaluation.empty()) record.scores = numbers_at(read_json(evaluation), kScores);
  } catch (const Json::exception& e) {
    throw InputError(folder + "/report.json", "a report of sketchsplat", e.what());
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file())
      record.files.push_back({entry.path().filename().string(), entry.file_size()});
  std::sort(record.files.begin(), record.files.end());
  return record;
}

void write_record(const std::string& folder, const SceneRecord& record) {
  Json json = {{"program", "sketchsplat"}, {"key", json_of(record.key)}, {"format", record.format}};
  json["counts"] = numbers_json(record.counts);
  json["warnings"] = record.warnings;
  json["scores"] = numbers_json(record.scores);
  json["note"] = record.note;
  json["files"] = Json::object();
  for (const auto& [name, size] : record.files) json["files"][name] = size;
  write_atomically(folder + kName, [&](std::ostream& out) { out << dump(json); });
}

bool is_done(const std::string& folder, const SceneKey& key, SceneRecord* record) {
  SceneRecord found = read_record(folder);
  const bool done = found.key.matches(key) &&
                    std::all_of(found.files.begin(), found.files.end(), [&](const auto& file) {
                      std::error_code error;
                      const std::uintmax_t size =
                          fs::file_size(fs::path(folder) / file.first, error);
                      return !error && size == file.second;
                    });
  found.files.clear();
  if (done && record) *record = std::move(found);
  return done;
}

void write_run(const std::string& path, const RunRecord& run) {
  const Json json = {
      {"key", json_of(run.key)},  {"status", run.status},   {"reason", run.reason},
      {"attempts", run.attempts}, {"seconds", run.seconds}, {"cpu_seconds", run.cpu_seconds},
      {"peak_mb", run.peak_mb},   {"host", run.host},       {"ended", run.ended}};
  write_atomically(path, [&](std::ostream& out) { out << dump(json); });
}

RunRecord read_run(const std::string& path) {
  RunRecord run;
  try {
    const Json json = read_json(path);
    run.status = json.at("status");
    run.reason = json.at("reason");
    run.attempts = json.at("attempts");
    run.seconds = json.at("seconds");
    run.cpu_seconds = json.at("cpu_seconds");
    run.peak_mb = json.at("peak_mb");
    run.host = json.at("host");
    run.ended = json.at("ended");
    run.key = key_in(json.at("key"));
  } catch (const std::exception&) {
    return {};
  }
  return run;
}

}  // namespace sketchsplat
